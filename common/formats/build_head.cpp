#include "common/formats/build_head.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/shapes/shape_bytes.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone {
namespace {

/// The bit of a material's visibility and body that says that a look follows.
constexpr std::uint8_t kBuildHasLook = 16;
/// The bit that says that a shape follows.
constexpr std::uint8_t kBuildHasShape = 32;

void write_material_text(ByteWriter& w, std::string_view text) {
  w.varint(text.size());
  w.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string read_material_text(ByteReader& r, std::size_t bytes_max, const char* what) {
  const ByteView text = r.bytes(static_cast<std::size_t>(r.varint_max(bytes_max, what)));
  return {text.begin(), text.end()};
}

Result<void> check_build_material(const BuildMaterial& material) {
  if (material.row.visibility > Visibility::transparent)
    return fail(ErrorCode::bad_value, "material of the build has an unknown visibility");
  if (material.states.size() > kBuildStatesBytesMax || !is_printable_utf8(material.states))
    return fail(ErrorCode::bad_value,
                "states must be at most 256 bytes of UTF-8 without control characters");
  const MaterialRow& row = material.row;
  if (!row.shape.is_cube() && row.visibility == Visibility::empty)
    return fail(ErrorCode::bad_value, "material of the build is empty and has a shape");
  if (const auto sound = validate_shape(row.shape); !sound) return sound;
  return validate_material(row.name, row.colour, row.visibility, row.body, row.look);
}

}  // namespace

Result<void> validate_build_materials(std::span<const BuildMaterial> materials) {
  std::set<const Shape*, ShapeBefore> shapes;
  if (materials.empty()) return fail(ErrorCode::bad_value, "build has no material");
  if (materials.size() > kBuildMaterialsMax)
    return fail(ErrorCode::limit_exceeded, "build has more than 65535 materials");
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (auto sound = check_build_material(materials[i]); !sound)
      return fail(sound.error().code, sound.error().what, i);
    const Shape& shape = materials[i].row.shape;
    if (!shape.is_cube() && shapes.insert(&shape).second) {
      if (const auto sound = check_shape(shape); !sound)
        return fail(sound.error().code, sound.error().what, i);
    }
    if (i == 0) continue;
    const BuildMaterial& before = materials[i - 1];
    if (std::tie(before.row.name, before.states) >=
        std::tie(materials[i].row.name, materials[i].states))
      return fail(ErrorCode::not_canonical, "materials of the build do not ascend", i);
  }
  return {};
}

Bytes encode_build_head(const BuildHead& head) {
  RUNSTONE_ASSERT(head.material_count >= 1 && head.material_count <= kBuildMaterialsMax);
  Bytes out;
  ByteWriter w(out);
  write_build_info(w, head.info);
  w.varint(head.material_count - 1);
  return out;
}

Result<BuildHead> decode_build_head(ByteView in) {
  ByteReader r(in);
  BuildHead head;
  head.info = read_build_info(r);
  head.material_count = 1 + static_cast<std::uint32_t>(r.varint_max(
                                kBuildMaterialsMax - 1, "build has more than 65535 materials"));
  if (const auto done = r.finish(); !done) return failure(done.error());
  return head;
}

void encode_build_material(const BuildMaterial& material, Bytes& out) {
  RUNSTONE_ASSERT(check_build_material(material).has_value());
  const MaterialRow& row = material.row;
  ByteWriter w(out);
  write_material_text(w, row.name);
  write_material_text(w, material.states);
  w.bytes(row.colour);
  w.u8(static_cast<std::uint8_t>(static_cast<unsigned>(row.visibility) |
                                 static_cast<unsigned>(row.body) << 2 |
                                 (row.look ? unsigned{kBuildHasLook} : 0U) |
                                 (row.shape.is_cube() ? 0U : unsigned{kBuildHasShape})));
  if (row.look) {
    for (const std::uint8_t byte :
         {row.look->variation, row.look->grain, row.look->roughness, row.look->emission,
          static_cast<std::uint8_t>(row.look->pattern)}) {
      w.u8(byte);
    }
  }
  if (!row.shape.is_cube()) write_shape(w, row.shape);
}

bool has_shape(std::span<const BuildMaterial> materials) {
  return std::any_of(materials.begin(), materials.end(),
                     [](const BuildMaterial& material) { return !material.row.shape.is_cube(); });
}

Result<void> decode_build_materials(ByteView in, std::uint32_t count, bool with_shapes,
                                    std::vector<BuildMaterial>& out) {
  ByteReader r(in);
  for (std::uint32_t i = 0; i < count && r.ok(); ++i) {
    BuildMaterial material;
    MaterialRow& row = material.row;
    row.name = read_material_text(r, kMaterialNameBytesMax, "name of a material is too long");
    material.states =
        read_material_text(r, kBuildStatesBytesMax, "states of a material are too long");
    const ByteView colour = r.bytes(row.colour.size());
    std::copy(colour.begin(), colour.end(), row.colour.begin());
    const std::uint8_t bits = r.u8();
    if (bits >= (with_shapes ? kBuildHasShape : kBuildHasLook) * 2)
      r.reject(ErrorCode::bad_value, "material has unknown bits of visibility and body");
    row.visibility = static_cast<Visibility>(bits & 3);
    row.body = static_cast<MaterialBody>(bits >> 2 & 3);
    if ((bits & kBuildHasLook) != 0) {
      MaterialLook look;
      for (std::uint8_t* share : {&look.variation, &look.grain, &look.roughness, &look.emission})
        *share = r.u8();
      look.pattern = static_cast<MaterialPattern>(r.u8());
      row.look = look;
    }
    if ((bits & kBuildHasShape) != 0) row.shape = read_shape(r);
    if (!r.ok()) break;
    if (const auto sound = check_build_material(material); !sound)
      r.reject(sound.error().code, sound.error().what);
    out.push_back(std::move(material));
  }
  return r.finish();
}

}  // namespace runstone
