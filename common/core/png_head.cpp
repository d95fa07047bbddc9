#include "common/core/png_head.hpp"

#include <algorithm>
#include <array>

namespace runstone {

std::optional<PngSides> png_sides(ByteView png) {
  // The signature of a PNG, and the length and name of its first chunk.
  constexpr std::array<std::uint8_t, 16> kHeadOfPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                                       0,    0,   0,   13,  'I',  'H',  'D',  'R'};
  if (png.size() < kHeadOfPng.size() + 8 ||
      !std::equal(kHeadOfPng.begin(), kHeadOfPng.end(), png.begin()))
    return std::nullopt;
  const auto side = [png](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | png[at + i];
    return value;
  };
  const PngSides sides{side(16), side(20)};
  if (sides.width == 0 || sides.height == 0) return std::nullopt;
  return sides;
}

}  // namespace runstone
