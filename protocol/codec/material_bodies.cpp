#include "protocol/codec/body_reader.hpp"

namespace runstone {

Result<Message> BodyReader::read(const wire::MaterialsAdded& t) const {
  const auto count = count_of(t.rows(), kMaterialCountMax);
  if (!count || *count == 0 || t.first() == 0 || t.first() > kMaterialCountMax - *count)
    return bad("materials_added names no rows, or rows outside the table");
  MaterialsAdded m;
  m.first = static_cast<Material>(t.first());
  m.rows.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (!take_material(*t.rows()->Get(i), m.rows[i])) return bad("bad row in materials_added");
    if (t.rows()->Get(i)->shape() != 0) return bad("a row in materials_added has a shape");
  }
  // An empty table checks the rows as far as they do not depend on the world's other rows.
  if (const auto sound = MaterialTable{}.check_rows(m.rows); !sound) return failure(sound.error());
  return m;
}

Result<Message> BodyReader::read(const wire::ShapesGiven& t) const {
  const ByteView bytes = view_of(t.shapes());
  if (bytes.size() > kGivenShapesBytesMax)
    return fail(ErrorCode::limit_exceeded, "shapes_given is too long");
  ByteReader r(bytes);
  ShapesGiven m{read_given_shapes(r)};
  if (const auto done = r.finish(); !done) return failure(done.error());
  if (const auto sound = validate(m.given); !sound) return failure(sound.error());
  return m;
}

}  // namespace runstone
