// Integer arithmetic of the voxeliser. Internal to this room.
#pragma once
#include <cstdint>

namespace runstone {

/// Returns the quotient rounded down, or up. Requires b > 0.
constexpr std::int64_t quotient_down(std::int64_t a, std::int64_t b) {
  return a / b - static_cast<std::int64_t>(a % b < 0);
}
constexpr std::int64_t quotient_up(std::int64_t a, std::int64_t b) {
  return a / b + static_cast<std::int64_t>(a % b > 0);
}

/// Numbers low .. high, both included; none if low > high.
struct WholeRange {
  std::int64_t low = 0, high = -1;
  constexpr bool empty() const { return low > high; }
  /// Keeps the numbers i with slope * i + at_zero >= 0. It divides only if an end is cut off.
  constexpr void keep(std::int64_t slope, std::int64_t at_zero) {
    if (empty()) return;
    const bool keeps_low = slope * low + at_zero >= 0;
    const bool keeps_high = slope * high + at_zero >= 0;
    if (keeps_low && keeps_high) return;
    if (!keeps_low && !keeps_high) {
      high = low - 1;
    } else if (keeps_high) {
      low = quotient_up(-at_zero, slope);
    } else {
      high = quotient_down(at_zero, -slope);
    }
  }
};

}  // namespace runstone
