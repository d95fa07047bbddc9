// The linear share of light of an sRGB value, as glTF's materials have it.
#pragma once
#include <cmath>
#include <cstdint>

namespace runstone {

/// Returns 0 .. 1 (IEC 61966-2-1).
inline double linear_share(std::uint8_t srgb) {
  const double v = srgb / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace runstone
