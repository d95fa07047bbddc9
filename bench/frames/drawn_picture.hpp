// DrawnPicture: a drawn picture, and its difference from another mesher's picture of the same
// voxels.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace runstone::bench {

struct DrawnPicture {
  int width = 0, height = 0;          // pixels
  std::vector<std::uint32_t> pixels;  // a colour each; 0 where nothing was drawn
};

struct PictureDifference {
  std::size_t seam_pixels = 0;  // of another colour
  /// The seam pixels inside a plane of the other picture: there, all eight pixels around have the
  /// same colour. The other seam pixels lie where planes meet, and may come from a different
  /// rounding of the line between them.
  std::size_t pinhole_pixels = 0;
};

/// Returns the number of pixels with something drawn in them.
std::size_t covered_pixels(const DrawnPicture& picture);

/// Compares two pictures. Requires the same size.
PictureDifference difference_of(const DrawnPicture& picture, const DrawnPicture& from);

}  // namespace runstone::bench
