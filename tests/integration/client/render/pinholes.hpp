// Counts pinholes in a picture of plane colours (tests/support/mesh/plane_colours.hpp).
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "client/render/image.hpp"

namespace runstone {

/// Returns the number of pixels of another colour than in the other picture, where that one has
/// nearly the same colour all around.
inline std::size_t pinholes(const Image& picture, const Image& from) {
  const auto difference = [](const Image& a, int ax, int ay, const Image& b, int bx, int by) {
    int most = 0;
    for (int c = 0; c < 3; ++c) {
      const auto at = [c](const Image& image, int x, int y) {
        return int{image.rgb[static_cast<std::size_t>((y * image.width + x) * 3 + c)]};
      };
      most = std::max(most, std::abs(at(a, ax, ay) - at(b, bx, by)));
    }
    return most;
  };
  std::size_t out = 0;
  for (int y = 1; y + 1 < from.height; ++y) {
    for (int x = 1; x + 1 < from.width; ++x) {
      if (difference(picture, x, y, from, x, y) < 12) continue;
      bool is_inside = true;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx)
          is_inside = is_inside && difference(from, x + dx, y + dy, from, x, y) < 10;
      }
      out += is_inside ? 1 : 0;
    }
  }
  return out;
}

}  // namespace runstone
