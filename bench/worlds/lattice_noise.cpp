#include "bench/worlds/lattice_noise.hpp"

#include <array>
#include <cmath>

#include "common/core/hash.hpp"

namespace runstone::bench {
namespace {

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double noise_octave(double x, double y, double z, std::uint32_t seed) {
  const std::array<double, 3> low = {std::floor(x), std::floor(y), std::floor(z)};
  const std::array<double, 3> t = {fade(x - low[0]), fade(y - low[1]), fade(z - low[2])};
  const auto at = [&](int i, int j, int k) {
    return lattice_value(static_cast<std::int32_t>(low[0]) + i,
                         static_cast<std::int32_t>(low[1]) + j,
                         static_cast<std::int32_t>(low[2]) + k, seed);
  };
  const auto mix = [](double a, double b, double share) { return a + (b - a) * share; };
  const auto along_x = [&](int j, int k) { return mix(at(0, j, k), at(1, j, k), t[0]); };
  const auto along_y = [&](int k) { return mix(along_x(0, k), along_x(1, k), t[1]); };
  return mix(along_y(0), along_y(1), t[2]);
}

}  // namespace

double lattice_value(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
  const auto word = [](std::int32_t v) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v));
  };
  const std::uint64_t hash =
      mix64(mix64(word(x) | word(y) << 32) ^ (word(z) | std::uint64_t{seed} << 32));
  return static_cast<double>(hash >> 11) * 0x1p-52 - 1;
}

double fractal_noise(double x, double y, double z, std::uint32_t seed, unsigned octaves) {
  double sum = 0, weight = 1, weights = 0;
  for (unsigned o = 0; o < octaves; ++o) {
    sum += weight * noise_octave(x, y, z, seed + o);
    weights += weight;
    weight *= 0.5;
    x *= 2, y *= 2, z *= 2;
  }
  return sum / weights;
}

}  // namespace runstone::bench
