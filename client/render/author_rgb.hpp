// The colour of a player, by the number of the author: of the body, of ghosts and of the timeline.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

/// Returns red, green and blue. Authors with near numbers have different colours; the server (0) is
/// grey.
inline std::array<std::uint8_t, 3> author_rgb(AuthorId author) {
  if (author == 0) return {150, 155, 160};
  // Steps of the golden section spread hues evenly, however many there are.
  constexpr double kGolden = 0.6180339887, kSaturation = 0.62;
  const double value = author % 2 == 0 ? 0.80 : 0.97;
  const double turn = author * kGolden;
  const double hue = 6 * (turn - std::floor(turn));  // in sixths of the circle
  std::array<std::uint8_t, 3> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    // The pure colours of the three channels have the hues 0, 2 and 4. `below` is the share by
    // which this channel is less than the greatest one.
    const double from = std::fabs(hue - 2.0 * static_cast<double>(i));
    const double near = std::min(from, 6 - from);
    const double below = std::clamp(near - 1, 0.0, 1.0);
    out[i] = static_cast<std::uint8_t>(std::lround(255 * value * (1 - kSaturation * below)));
  }
  return out;
}

}  // namespace runstone
