// Lattice noise: fractal value noise in three dimensions for benchmark worlds. Random values on the
// integer lattice are blended with a quintic fade. Each octave has twice the frequency and half the
// weight.
#pragma once
#include <cstdint>

namespace runstone::bench {

/// Returns a uniform value in [-1, 1), fixed for a place and a seed.
double lattice_value(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed);

/// Returns a value in [-1, 1]. Requires 0 < octaves. Cost: about 20 ns an octave.
double fractal_noise(double x, double y, double z, std::uint32_t seed, unsigned octaves);

}  // namespace runstone::bench
