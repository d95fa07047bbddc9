#include "common/generate/landscape/lattice_noise.hpp"

#include "common/core/assert.hpp"
#include "common/core/hash.hpp"

namespace runstone {
namespace {

/// Directions of length sqrt(2), times 256. With this length the noise reaches one.
constexpr std::array<std::int32_t, 16> kGradientX = {362,  334,  256,  139,  0, -139, -256, -334,
                                                     -362, -334, -256, -139, 0, 139,  256,  334};
constexpr std::array<std::int32_t, 16> kGradientZ = {0, 139,  256,  334,  362,  334,  256,  139,
                                                     0, -139, -256, -334, -362, -334, -256, -139};

}  // namespace

LatticeNoise::LatticeNoise(std::uint64_t key, unsigned log2_wavelength)
    : key_(mix64(key)), bits_(log2_wavelength) {
  RUNSTONE_ASSERT(bits_ >= 2 && bits_ <= 16);
  // Blocks of eight voxels stay inside a cell, so that they share their gradients.
  const std::int32_t places = std::max(1, (1 << bits_) >> 3);
  SplitMix64 shifts(key_);
  shift_x_ = static_cast<std::int32_t>(shifts.below(static_cast<std::uint32_t>(places))) << 3;
  shift_z_ = static_cast<std::int32_t>(shifts.below(static_cast<std::uint32_t>(places))) << 3;
}

LatticeNoise::Cell LatticeNoise::cell_of(std::int32_t x, std::int32_t z) const {
  const std::int32_t i = (x + shift_x_) >> bits_, k = (z + shift_z_) >> bits_;
  Cell out;
  for (std::int32_t corner = 0; corner < 4; ++corner) {
    const auto at_x = static_cast<std::uint32_t>(i + (corner & 1));
    const auto at_z = static_cast<std::uint32_t>(k + (corner >> 1));
    const std::size_t direction = mix64(key_ ^ at_x ^ (std::uint64_t{at_z} << 32)) >> 60;
    out.gx[static_cast<std::size_t>(corner)] = kGradientX[direction];
    out.gz[static_cast<std::size_t>(corner)] = kGradientZ[direction];
  }
  return out;
}

std::int32_t LatticeNoise::in(const Cell& cell, std::int32_t x, std::int32_t z) const {
  const std::int32_t mask = (1 << bits_) - 1;
  const std::int32_t u = (((x + shift_x_) & mask) << 12) >> bits_;
  const std::int32_t v = (((z + shift_z_) & mask) << 12) >> bits_;
  const auto corner = [&](std::size_t i, std::int32_t dx, std::int32_t dz) {
    return (cell.gx[i] * dx + cell.gz[i] * dz) >> 8;
  };
  const std::int32_t fade_x = fade_of(u), fade_z = fade_of(v);
  const std::int32_t a = corner(0, u, v), b = corner(1, u - kOne, v);
  const std::int32_t c = corner(2, u, v - kOne), d = corner(3, u - kOne, v - kOne);
  const std::int32_t low = a + (((b - a) * fade_x) >> 12);
  const std::int32_t high = c + (((d - c) * fade_x) >> 12);
  return low + (((high - low) * fade_z) >> 12);
}

}  // namespace runstone
