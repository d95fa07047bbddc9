// LatticeNoise: gradient noise in fixed point. Its wavelength is a power of two, so a column's cell
// and its place in the cell are a shift and a mask. It uses integers only, so every compiler gives
// equal bits. Source: Perlin, Improving Noise (2002), with 16 directions.
#pragma once
#include <array>
#include <cstdint>

namespace runstone {

/// One as a fixed-point number: noise, shares and factors of landscape have 12 fractional bits.
inline constexpr std::int32_t kOne = 4096;

/// Returns 6t^5 - 15t^4 + 10t^3. Requires 0 <= t <= kOne.
constexpr std::int32_t fade_of(std::int32_t t) {
  const std::int64_t u = t;
  return static_cast<std::int32_t>(
      (u * u * u * (u * (6 * u - 15 * kOne) + std::int64_t{10} * kOne * kOne)) >> 48);
}

/// Returns 0 below `low`, kOne from `high` on, and a line between them. Requires low < high.
constexpr std::int32_t ramp(std::int32_t value, std::int32_t low, std::int32_t high) {
  if (value <= low) return 0;
  if (value >= high) return kOne;
  return static_cast<std::int32_t>(std::int64_t{value - low} * kOne / (high - low));
}

/// Returns a * b for fixed-point factors.
constexpr std::int32_t times(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>((std::int64_t{a} * b) >> 12);
}

class LatticeNoise {
 public:
  /// The four gradients around a cell, for many columns of it.
  struct Cell {
    std::array<std::int32_t, 4> gx, gz;  // corners (0, 0), (1, 0), (0, 1), (1, 1)
  };

  /// Requires 2 <= log2_wavelength <= 16, in voxels.
  LatticeNoise(std::uint64_t key, unsigned log2_wavelength);

  /// Returns noise within -kOne .. kOne.
  std::int32_t at(std::int32_t x, std::int32_t z) const { return in(cell_of(x, z), x, z); }
  /// Returns the cell that contains the column.
  Cell cell_of(std::int32_t x, std::int32_t z) const;
  /// Returns at(x, z) of a column in the cell.
  std::int32_t in(const Cell& cell, std::int32_t x, std::int32_t z) const;

 private:
  std::uint64_t key_;
  std::int32_t shift_x_, shift_z_;  // they keep the lattices of octaves apart
  unsigned bits_;
};

}  // namespace runstone
