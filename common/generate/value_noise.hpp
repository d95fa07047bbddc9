// ValueNoise: fractal value noise over columns, with the same bits on every compiler and machine.
// Random values sit on an integer lattice and are blended with a quintic fade. Three octaves are
// summed, each with twice the frequency and half the weight of the previous one. It uses doubles
// with + - * only (fused multiply-add is off for the whole project) and an integer hash, so the
// result depends on no maths library. Sources: value noise as in Ebert et al., Texturing and
// Modeling; the fade is Perlin 2002; octaves, weights and frequencies are those of the thesis'
// generators.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "common/runs/extent.hpp"

namespace runstone {

/// A side of the columns that fill() takes: those of the widest chunk, and one more, so that every
/// cell between columns has all its corners.
inline constexpr std::uint32_t kNoiseSideMax = kSideMax + 1;

class ValueNoise {
 public:
  /// Requires 0 < frequency <= 1 (cycles per voxel, of the first octave).
  ValueNoise(std::uint64_t seed, double frequency);

  /// Writes noise in [-1, 1] of width * depth columns, one in `stride` along both axes:
  /// out[i + width * k] belongs to (x + stride * i, z + stride * k). A column's value does not
  /// depend on the other arguments. Requires width, depth <= kNoiseSideMax, out.size() ==
  /// width * depth and stride > 0. Cost: O(width * depth).
  void fill(std::int32_t x, std::int32_t z, std::uint32_t width, std::uint32_t depth,
            std::span<double> out, std::int32_t stride = 1) const;

  double at(std::int32_t x, std::int32_t z) const;

 private:
  struct Octave {
    std::uint64_t key;
    double frequency;
    double weight;
    // Shifts of the octave, in lattice cells. They keep the octaves' lattices from meeting at the
    // origin.
    double shift_x, shift_z;
  };
  void add_octave(const Octave& octave, std::int32_t x, std::int32_t z, std::uint32_t width,
                  std::uint32_t depth, std::span<double> out, std::int32_t stride) const;
  std::array<Octave, 3> octaves_;
};

}  // namespace runstone
