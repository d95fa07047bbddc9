// Compares pictures.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdlib>

#include "client/render/image.hpp"

namespace runstone {

/// Returns the number of pixels that differ by more than rounding.
inline std::size_t different_pixels(const Image& a, const Image& b) {
  REQUIRE(a.rgb.size() == b.rgb.size());
  std::size_t out = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(int{a.rgb[i + c]} - int{b.rgb[i + c]}));
    out += most > 3 ? 1 : 0;
  }
  return out;
}

}  // namespace runstone
