#include "common/formats/build_info.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

/// The bit of a material's visibility and body that says that a look follows.
constexpr std::uint8_t kBuildHasLook = 16;

void write_build_text(ByteWriter& w, std::string_view text) {
  w.varint(text.size());
  w.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string read_build_text(ByteReader& r, std::size_t bytes_max, const char* what) {
  const ByteView text = r.bytes(static_cast<std::size_t>(r.varint_max(bytes_max, what)));
  return {text.begin(), text.end()};
}

bool is_build_side(std::uint32_t side) { return side >= 1 && side <= kBuildSideMax; }

Result<void> check_build_sides(const BuildSides& sides) {
  if (!is_build_side(sides.x) || !is_build_side(sides.y) || !is_build_side(sides.z))
    return fail(ErrorCode::limit_exceeded, "side of the build is outside 1 .. 1048576");
  return {};
}

bool is_build_name(std::string_view text, std::size_t bytes_max) {
  return text.size() <= bytes_max && is_plain_name(text);
}

Result<void> check_build_material(const BuildMaterial& material) {
  if (material.row.visibility > Visibility::transparent)
    return fail(ErrorCode::bad_value, "material of the build has an unknown visibility");
  if (material.states.size() > kBuildStatesBytesMax || !is_printable_utf8(material.states))
    return fail(ErrorCode::bad_value,
                "states must be at most 256 bytes of UTF-8 without control characters");
  const MaterialRow& row = material.row;
  return validate_material(row.name, row.colour, row.visibility, row.body, row.look);
}

}  // namespace

Result<void> validate(const BuildInfo& info) {
  if (!is_build_name(info.name, kBuildNameBytesMax))
    return fail(ErrorCode::bad_value, "name of the build must be a plain name of 1 .. 64 bytes");
  if (!info.author.empty() && !is_build_name(info.author, kBuildAuthorBytesMax))
    return fail(ErrorCode::bad_value, "author must be a plain name of at most 32 bytes, or empty");
  if (info.tags.size() > kBuildTagsMax)
    return fail(ErrorCode::limit_exceeded, "build has more than 16 tags");
  for (const std::string& tag : info.tags) {
    if (!is_build_name(tag, kBuildTagBytesMax))
      return fail(ErrorCode::bad_value, "tag must be a plain name of 1 .. 32 bytes");
  }
  if (std::adjacent_find(info.tags.begin(), info.tags.end(), std::greater_equal<>{}) !=
      info.tags.end())
    return fail(ErrorCode::not_canonical, "tags do not ascend");
  if (info.created_us < 0 || info.created_us > kBuildTimeMax)
    return fail(ErrorCode::bad_value, "time of the build is outside 0 .. 2^53");
  if (auto sides = check_build_sides(info.sides); !sides) return sides;
  // The limit of the world is below 2^31 - 2^20, so the sum fits.
  const auto fits = [](std::int32_t at, std::uint32_t side) {
    return at >= -kWorldLimit && at <= kWorldLimit - static_cast<std::int32_t>(side);
  };
  if (!fits(info.origin.x, info.sides.x) || !fits(info.origin.y, info.sides.y) ||
      !fits(info.origin.z, info.sides.z))
    return fail(ErrorCode::bad_value, "build reaches out of the world");
  return {};
}

Result<void> validate_build_materials(std::span<const BuildMaterial> materials) {
  if (materials.empty()) return fail(ErrorCode::bad_value, "build has no material");
  if (materials.size() > kBuildMaterialsMax)
    return fail(ErrorCode::limit_exceeded, "build has more than 65535 materials");
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (auto sound = check_build_material(materials[i]); !sound)
      return fail(sound.error().code, sound.error().what, i);
    if (i == 0) continue;
    const BuildMaterial& before = materials[i - 1];
    if (std::tie(before.row.name, before.states) >=
        std::tie(materials[i].row.name, materials[i].states))
      return fail(ErrorCode::not_canonical, "materials of the build do not ascend", i);
  }
  return {};
}

Bytes encode_build_info(const BuildInfo& info, std::size_t material_count) {
  RUNSTONE_ASSERT(validate(info).has_value());
  RUNSTONE_ASSERT(material_count >= 1 && material_count <= kBuildMaterialsMax);
  Bytes out;
  ByteWriter w(out);
  for (const std::uint32_t side : {info.sides.x, info.sides.y, info.sides.z}) w.varint(side - 1);
  for (const std::int32_t at : {info.origin.x, info.origin.y, info.origin.z}) w.svarint(at);
  w.varint(static_cast<std::uint64_t>(info.created_us));
  write_build_text(w, info.name);
  write_build_text(w, info.author);
  w.varint(info.tags.size());
  for (const std::string& tag : info.tags) write_build_text(w, tag);
  w.varint(material_count - 1);
  return out;
}

Result<BuildHead> decode_build_info(ByteView in) {
  ByteReader r(in);
  BuildHead head;
  BuildInfo& info = head.info;
  for (std::uint32_t* side : {&info.sides.x, &info.sides.y, &info.sides.z}) {
    *side = 1 + static_cast<std::uint32_t>(
                    r.varint_max(kBuildSideMax - 1, "side of the build is outside 1 .. 1048576"));
  }
  for (std::int32_t* at : {&info.origin.x, &info.origin.y, &info.origin.z}) {
    *at = static_cast<std::int32_t>(
        r.svarint_in(-kWorldLimit, kWorldLimit - 1, "origin lies outside the world"));
  }
  info.created_us =
      static_cast<TimeUs>(r.varint_max(kBuildTimeMax, "time of the build is outside 0 .. 2^53"));
  info.name = read_build_text(r, kBuildNameBytesMax, "name of the build is too long");
  info.author = read_build_text(r, kBuildAuthorBytesMax, "author of the build is too long");
  const std::uint64_t tags = r.varint_max(kBuildTagsMax, "build has more than 16 tags");
  for (std::uint64_t i = 0; i < tags && r.ok(); ++i)
    info.tags.push_back(read_build_text(r, kBuildTagBytesMax, "tag is too long"));
  head.material_count = 1 + static_cast<std::uint32_t>(r.varint_max(
                                kBuildMaterialsMax - 1, "build has more than 65535 materials"));
  if (const auto done = r.finish(); !done) return failure(done.error());
  if (const auto sound = validate(info); !sound) return failure(sound.error());
  return head;
}

void encode_build_material(const BuildMaterial& material, Bytes& out) {
  RUNSTONE_ASSERT(check_build_material(material).has_value());
  const MaterialRow& row = material.row;
  ByteWriter w(out);
  write_build_text(w, row.name);
  write_build_text(w, material.states);
  w.bytes(row.colour);
  w.u8(static_cast<std::uint8_t>(static_cast<unsigned>(row.visibility) |
                                 static_cast<unsigned>(row.body) << 2 |
                                 (row.look ? unsigned{kBuildHasLook} : 0U)));
  if (!row.look) return;
  for (const std::uint8_t byte :
       {row.look->variation, row.look->grain, row.look->roughness, row.look->emission,
        static_cast<std::uint8_t>(row.look->pattern)}) {
    w.u8(byte);
  }
}

Result<void> decode_build_materials(ByteView in, std::uint32_t count,
                                    std::vector<BuildMaterial>& out) {
  ByteReader r(in);
  for (std::uint32_t i = 0; i < count && r.ok(); ++i) {
    BuildMaterial material;
    MaterialRow& row = material.row;
    row.name = read_build_text(r, kMaterialNameBytesMax, "name of a material is too long");
    material.states = read_build_text(r, kBuildStatesBytesMax, "states of a material are too long");
    const ByteView colour = r.bytes(row.colour.size());
    std::copy(colour.begin(), colour.end(), row.colour.begin());
    const std::uint8_t bits = r.u8();
    if (bits >= kBuildHasLook * 2)
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
    if (!r.ok()) break;
    if (const auto sound = check_build_material(material); !sound)
      r.reject(sound.error().code, sound.error().what);
    out.push_back(std::move(material));
  }
  return r.finish();
}

}  // namespace runstone
