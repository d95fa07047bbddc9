#include "common/generate/value_noise.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/core/hash.hpp"

namespace runstone {
namespace {

/// Each column reads two lattice corners along x.
constexpr std::size_t kCornersMax = 2 * std::size_t{kNoiseSideMax};

/// Returns a lattice value in [-1, 1). It is a multiple of 2^-23, so it is exact in a double.
double corner_value(std::uint64_t key, std::int64_t i, std::int64_t k) {
  const std::uint64_t cell =
      (static_cast<std::uint64_t>(i) & 0xffffffffU) | (static_cast<std::uint64_t>(k) << 32);
  const auto top = static_cast<std::int64_t>(mix64(key ^ cell) >> 40);
  return static_cast<double>(top - (1 << 23)) * 0x1p-23;
}

/// 6t^5 - 15t^4 + 10t^3: from 0 to 1 with two vanishing derivatives at both ends.
double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

/// A lattice coordinate as its cell and the fade inside it.
struct Place {
  std::int64_t cell;
  double fade;
};

Place place_of(std::int32_t voxel, double frequency, double shift) {
  const double at = static_cast<double>(voxel) * frequency + shift;
  auto cell =
      static_cast<std::int64_t>(at);  // rounds towards zero: one too high for negative fractions
  cell -= static_cast<std::int64_t>(static_cast<double>(cell) > at);
  return {cell, fade(at - static_cast<double>(cell))};
}

}  // namespace

ValueNoise::ValueNoise(std::uint64_t seed, double frequency) : octaves_{} {
  RUNSTONE_ASSERT(frequency > 0 && frequency <= 1);
  SplitMix64 keys(seed);
  double weight = 4.0 / 7.0;  // 4/7 + 2/7 + 1/7: the sum stays in [-1, 1]
  for (Octave& octave : octaves_) {
    octave.key = keys.next();
    octave.frequency = frequency;
    octave.weight = weight;
    octave.shift_x = static_cast<double>(keys.below(1024)) * 0x1p-10;
    octave.shift_z = static_cast<double>(keys.below(1024)) * 0x1p-10;
    frequency *= 2;
    weight *= 0.5;
  }
}

void ValueNoise::fill(std::int32_t x, std::int32_t z, std::uint32_t width, std::uint32_t depth,
                      std::span<double> out, std::int32_t stride) const {
  RUNSTONE_ASSERT(width <= kNoiseSideMax && depth <= kNoiseSideMax &&
                  out.size() == std::size_t{width} * depth);
  std::fill(out.begin(), out.end(), 0.0);
  for (const Octave& octave : octaves_) add_octave(octave, x, z, width, depth, out, stride);
}

double ValueNoise::at(std::int32_t x, std::int32_t z) const {
  std::array<double, 1> out{};
  fill(x, z, 1, 1, out);
  return out[0];
}

void ValueNoise::add_octave(const Octave& octave, std::int32_t x, std::int32_t z,
                            std::uint32_t width, std::uint32_t depth, std::span<double> out,
                            std::int32_t stride) const {
  if (width == 0 || depth == 0) return;
  // The lattice corners along x that the columns read, ascending, and the left one of each column.
  // The right one is the next. Neighbouring columns share corners.
  std::array<std::int64_t, kCornersMax> cells;
  std::array<std::uint32_t, kNoiseSideMax> corner;
  std::array<double, kNoiseSideMax> fade_x;
  std::size_t corners = 0;
  for (std::uint32_t i = 0; i < width; ++i) {
    const Place place =
        place_of(x + stride * static_cast<std::int32_t>(i), octave.frequency, octave.shift_x);
    fade_x[i] = place.fade;
    if (corners == 0 || place.cell > cells[corners - 1]) cells[corners++] = place.cell;
    if (place.cell == cells[corners - 1]) cells[corners++] = place.cell + 1;
    corner[i] = static_cast<std::uint32_t>(corners - 2);
  }

  // Terrain frequencies put dozens of columns into one cell. So the two lattice rows around z
  // change rarely, and the blend along z is done once per corner instead of once per column.
  std::array<double, kCornersMax> near_row, far_row, row;
  std::int64_t loaded = 0;
  for (std::uint32_t k = 0; k < depth; ++k) {
    const Place place =
        place_of(z + stride * static_cast<std::int32_t>(k), octave.frequency, octave.shift_z);
    if (k == 0 || place.cell != loaded) {
      for (std::size_t c = 0; c < corners; ++c) {
        near_row[c] = corner_value(octave.key, cells[c], place.cell);
        far_row[c] = corner_value(octave.key, cells[c], place.cell + 1);
      }
      loaded = place.cell;
    }
    for (std::size_t c = 0; c < corners; ++c)
      row[c] = near_row[c] + (far_row[c] - near_row[c]) * place.fade;
    double* line = out.data() + std::size_t{k} * width;
    for (std::uint32_t i = 0; i < width; ++i) {
      const double left = row[corner[i]];
      line[i] += octave.weight * (left + (row[corner[i] + 1] - left) * fade_x[i]);
    }
  }
}

}  // namespace runstone
