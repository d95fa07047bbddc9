#include "common/core/texture.hpp"

#include <bit>

#include "common/core/png_head.hpp"

namespace runstone {
namespace {

/// The signature of a PNG, and its first chunk without the checksum.
constexpr std::size_t kHeadBytes = 8 + 8 + 13;

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
  const auto sides = png_sides(png);
  if (!sides || png.size() < kHeadBytes) return fail(ErrorCode::bad_value, "the picture is no PNG");
  const std::uint32_t edge = sides->width;
  if (sides->height != edge || !std::has_single_bit(edge) || edge < kTextureEdgeMin ||
      edge > kTextureEdgeMax)
    return fail(ErrorCode::bad_value, "the picture is not square with 16, 32 or 64 pixels a side");
  if (!has_known_colours(png[24], png[25]))
    return fail(ErrorCode::bad_value,
                "the picture has colours of more than 8 bits or of no known type");
  if (png[26] != 0 || png[27] != 0 || png[28] > 1)
    return fail(ErrorCode::bad_value, "the picture is packed in no known way");
  return static_cast<std::uint16_t>(edge);
}

}  // namespace runstone
