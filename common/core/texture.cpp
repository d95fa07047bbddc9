#include "common/core/texture.hpp"

#include <algorithm>

namespace runstone {
namespace {

/// The signature of a PNG, and the length and name of its first chunk.
constexpr std::array<std::uint8_t, 16> kHeadOfPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                                     0,    0,   0,   13,  'I',  'H',  'D',  'R'};
/// The head and the 13 bytes of the first chunk.
constexpr std::size_t kHeadBytes = kHeadOfPng.size() + 13;

std::uint32_t big_endian_at(ByteView bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
  return value;
}

/// Returns true if the PNG has colours of this type with so many bits.
bool has_known_colours(std::uint8_t bits, std::uint8_t type) {
  constexpr std::uint8_t kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6;
  if (type == kGrey || type == kPalette) return bits == 1 || bits == 2 || bits == 4 || bits == 8;
  return (type == kRgb || type == kGreyAlpha || type == kRgba) && bits == 8;
}

}  // namespace

Result<void> check_texture_uses(const std::vector<TextureUse>& uses) {
  if (uses.empty()) return fail(ErrorCode::bad_value, "a picture has no uses");
  if (uses.size() > kTextureUsesMax)
    return fail(ErrorCode::limit_exceeded, "a picture has too many uses", kTextureUsesMax);
  Material before = kEmpty;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (uses[i].material <= before)
      return fail(ErrorCode::bad_value, "materials of a picture do not ascend from 1", i);
    if (uses[i].sides == 0 || uses[i].sides > kAllTextureSides)
      return fail(ErrorCode::bad_value, "sides of a picture are not 1 .. 63", i);
    before = uses[i].material;
  }
  return {};
}

Result<std::uint16_t> texture_edge(ByteView png) {
  if (png.size() > kTextureBytesMax)
    return fail(ErrorCode::limit_exceeded, "the picture is longer than 24,576 bytes");
  if (png.size() < kHeadBytes || !std::ranges::equal(png.first(kHeadOfPng.size()), kHeadOfPng))
    return fail(ErrorCode::bad_value, "the picture is no PNG");
  const std::uint32_t width = big_endian_at(png, 16), height = big_endian_at(png, 20);
  if (width != height || (width != 16 && width != 32 && width != 64))
    return fail(ErrorCode::bad_value, "the picture is not square with 16, 32 or 64 pixels a side");
  if (!has_known_colours(png[24], png[25]))
    return fail(ErrorCode::bad_value,
                "the picture has colours of more than 8 bits or of no known type");
  if (png[26] != 0 || png[27] != 0 || png[28] > 1)
    return fail(ErrorCode::bad_value, "the picture is packed in no known way");
  return static_cast<std::uint16_t>(width);
}

}  // namespace runstone
