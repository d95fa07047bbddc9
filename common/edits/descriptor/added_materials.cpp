#include "common/edits/descriptor/added_materials.hpp"

#include <algorithm>
#include <string_view>

namespace runstone {
namespace {

/// The bit of a row's visibility and body that says that a look follows.
constexpr std::uint8_t kHasLook = 16;

void write_look(ByteWriter& w, const MaterialLook& look) {
  for (const std::uint8_t byte : {look.variation, look.grain, look.roughness, look.emission,
                                  static_cast<std::uint8_t>(look.pattern)}) {
    w.u8(byte);
  }
}

MaterialLook read_look(ByteReader& r) {
  MaterialLook look;
  for (std::uint8_t* share : {&look.variation, &look.grain, &look.roughness, &look.emission})
    *share = r.u8();
  look.pattern = static_cast<MaterialPattern>(r.u8());
  return look;
}

}  // namespace

Result<void> validate(const AddedMaterials& added) {
  if (added.rows.empty()) return fail(ErrorCode::bad_value, "no materials are added");
  if (added.rows.size() > kAddedMaterialsMax)
    return fail(ErrorCode::limit_exceeded, "too many materials are added");
  if (added.first == kEmpty || added.first + added.rows.size() > kMaterialCountMax)
    return fail(ErrorCode::bad_value, "ids of added materials out of range");
  std::vector<std::string_view> names;
  names.reserve(added.rows.size());
  for (const MaterialRow& row : added.rows) {
    if (row.visibility > Visibility::transparent)
      return fail(ErrorCode::bad_value, "unknown visibility");
    if (auto sound = validate_material(row.name, row.colour, row.visibility, row.body, row.look);
        !sound)
      return sound;
    if (!row.shape.is_cube())
      return fail(ErrorCode::bad_value, "a record of new materials has no shapes");
    names.push_back(row.name);
  }
  std::sort(names.begin(), names.end());
  if (std::adjacent_find(names.begin(), names.end()) != names.end())
    return fail(ErrorCode::bad_value, "two added materials have one name");
  return {};
}

bool has_looks(const AddedMaterials& added) {
  return std::any_of(added.rows.begin(), added.rows.end(),
                     [](const MaterialRow& row) { return row.look.has_value(); });
}

void write_added_materials(ByteWriter& w, const AddedMaterials& added) {
  w.varint(added.first);
  w.varint(added.rows.size() - 1);
  for (const MaterialRow& row : added.rows) {
    w.varint(row.name.size());
    w.bytes({reinterpret_cast<const std::uint8_t*>(row.name.data()), row.name.size()});
    w.bytes(row.colour);
    w.u8(static_cast<std::uint8_t>(static_cast<unsigned>(row.visibility) |
                                   static_cast<unsigned>(row.body) << 2 |
                                   (row.look ? kHasLook : 0U)));
    if (row.look) write_look(w, *row.look);
  }
}

AddedMaterials read_added_materials(ByteReader& r, bool with_looks) {
  AddedMaterials added;
  added.first = static_cast<Material>(r.varint_max(0xffff, "material id exceeds 16 bits"));
  const std::uint64_t count =
      1 + r.varint_max(kAddedMaterialsMax - 1, "too many materials are added");
  while (r.ok() && added.rows.size() < count) {
    MaterialRow row;
    const std::uint64_t length = r.varint_max(kMaterialNameBytesMax, "material name too long");
    const ByteView name = r.bytes(static_cast<std::size_t>(length));
    row.name.assign(name.begin(), name.end());
    const ByteView colour = r.bytes(row.colour.size());
    std::copy(colour.begin(), colour.end(), row.colour.begin());
    std::uint8_t kind = r.u8();
    if (with_looks && (kind & kHasLook) != 0) {
      kind ^= kHasLook;
      row.look = read_look(r);
    }
    row.visibility = static_cast<Visibility>(kind & 3);
    row.body = static_cast<MaterialBody>(kind >> 2);
    added.rows.push_back(std::move(row));
  }
  if (r.ok() && with_looks && !has_looks(added))
    r.reject(ErrorCode::not_canonical, "no look in the kind of materials with looks");
  return added;
}

}  // namespace runstone
