// DrawnPicture: what was drawn, and how far another mesher's picture of the same voxels is from it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace runstone::bench {

struct DrawnPicture {
  int width = 0, height = 0;          // pixels
  std::vector<std::uint32_t> pixels;  // a colour each; 0: nothing was drawn there
};

struct PictureDifference {
  std::size_t seam_pixels = 0;  // of another colour
  /// Of these, those inside a plane of the other picture: all eight pixels around have its colour there. What
  /// is left lies where planes meet, and may be no more than another rounding of the line between them.
  std::size_t pinhole_pixels = 0;
};

/// Pixels with something drawn in them.
std::size_t covered_pixels(const DrawnPicture& picture);

/// Requires pictures of one size.
PictureDifference difference_of(const DrawnPicture& picture, const DrawnPicture& from);

}  // namespace runstone::bench
