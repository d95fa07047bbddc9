#include "bench/frames/drawn_picture.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone::bench {

std::size_t covered_pixels(const DrawnPicture& picture) {
  return picture.pixels.size() -
         static_cast<std::size_t>(std::count(picture.pixels.begin(), picture.pixels.end(), 0u));
}

PictureDifference difference_of(const DrawnPicture& picture, const DrawnPicture& from) {
  RUNSTONE_ASSERT(picture.width == from.width && picture.height == from.height);
  const auto at = [&from](int x, int y) {
    return from.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(from.width) +
                       static_cast<std::size_t>(x)];
  };
  const auto inside_a_plane = [&](int x, int y) {
    if (x == 0 || y == 0 || x == from.width - 1 || y == from.height - 1 || at(x, y) == 0)
      return false;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (at(x + dx, y + dy) != at(x, y)) return false;
      }
    }
    return true;
  };
  PictureDifference out;
  std::size_t pixel = 0;
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x, ++pixel) {
      if (picture.pixels[pixel] == from.pixels[pixel]) continue;
      ++out.seam_pixels;
      out.pinhole_pixels += inside_a_plane(x, y) ? 1 : 0;
    }
  }
  return out;
}

}  // namespace runstone::bench
