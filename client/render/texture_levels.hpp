// TextureLevels: a picture of a material's side as the GPU samples it, in its own size and in each
// half of it down to one pixel. Pure.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "common/textures/texture_picture.hpp"

namespace runstone {

/// Pixels with less alpha than this are holes.
inline constexpr std::uint8_t kHoleAlpha = 128;

struct TextureLevels {
  std::uint16_t edge = 0;  // of the first level, pixels, a power of two
  /// Each level has 4 bytes a pixel, sRGB and alpha, the upper row first.
  std::vector<std::vector<std::uint8_t>> levels;
};
using TextureLevelsPtr = std::shared_ptr<const TextureLevels>;

/// Makes the levels. A pixel of a level is the mean of four of the level before, in linear light
/// and weighted with their alpha. Holes get the mean colour of the picture: an opaque material
/// shows it there, and a filter mixes it in at their edges. In every level, at least as large a
/// share of the picture is solid as in the first one, where the GPU mixes pixels; otherwise thin
/// grass would vanish far away. Requires a picture whose edge is a power of two. Cost: O(pixels).
TextureLevels texture_levels(const TexturePicture& picture);

}  // namespace runstone
