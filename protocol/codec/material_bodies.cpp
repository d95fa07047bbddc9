#include <utility>

#include "protocol/codec/body_reader.hpp"

namespace runstone {

Result<Message> BodyReader::read(const wire::MaterialsAdded& t) const {
  const auto count = count_of(t.rows(), kMaterialCountMax);
  if (!count || *count == 0 || t.first() == 0 || t.first() > kMaterialCountMax - *count)
    return bad("materials_added names no rows, or rows outside the table");
  MaterialsAdded m;
  m.first = static_cast<Material>(t.first());
  // A table of their own checks the rows as far as they do not depend on the world's other rows.
  MaterialTable rows;
  for (std::uint32_t i = 0; i < *count; ++i) {
    MaterialInfo info;
    if (!take_material(*t.rows()->Get(i), info)) return bad("bad row in materials_added");
    if (const auto id = rows.add(std::move(info)); !id) return Unexpected<Error>{id.error()};
  }
  m.rows.assign(rows.rows().begin() + 1, rows.rows().end());
  return m;
}

}  // namespace runstone
