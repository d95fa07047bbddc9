#include "client/render/noise_texture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/core/hash.hpp"

namespace runstone {
namespace {

/// The spots of clouds, and those of tints, in a side of the texture.
constexpr unsigned kCloudCells = 8, kTintCells = 16;
constexpr std::uint64_t kCloudSeed = 1, kTintSeed = 2;

/// Adds one octave: random values at the corners of cells, with smooth steps between them.
void add_octave(std::vector<double>& to, unsigned side, unsigned cells, double strength,
                SplitMix64& rng) {
  std::vector<double> corners(std::size_t{cells} * cells);
  for (double& corner : corners) corner = static_cast<double>(rng.below(1U << 16)) / 65536.0;
  const unsigned width = side / cells;
  const auto smooth = [&](unsigned at) {
    const double t = static_cast<double>(at % width) / width;
    return t * t * (3 - 2 * t);
  };
  for (unsigned y = 0; y < side; ++y) {
    const unsigned row = y / width, next_row = (row + 1) % cells;
    for (unsigned x = 0; x < side; ++x) {
      const unsigned column = x / width, next = (column + 1) % cells;
      const auto at = [&](unsigned of_row, unsigned of_column) {
        return corners[std::size_t{of_row} * cells + of_column];
      };
      const double upper = std::lerp(at(row, column), at(row, next), smooth(x));
      const double lower = std::lerp(at(next_row, column), at(next_row, next), smooth(x));
      to[std::size_t{y} * side + x] += strength * std::lerp(upper, lower, smooth(y));
    }
  }
}

/// Most values of noise are near the middle. Returns a value that is farther from it.
std::uint8_t with_contrast(std::uint8_t value) {
  return static_cast<std::uint8_t>(std::clamp(128 + (value - 128) * 9 / 5, 0, 255));
}

}  // namespace

std::vector<std::uint8_t> repeating_noise(unsigned side, unsigned cells, std::uint64_t seed) {
  std::vector<double> sum(std::size_t{side} * side, 0.0);
  SplitMix64 rng(seed);
  double strength = 1;
  for (unsigned of_octave = cells; of_octave <= side / 2; of_octave *= 2, strength /= 2)
    add_octave(sum, side, of_octave, strength, rng);
  const auto [least, most] = std::minmax_element(sum.begin(), sum.end());
  const double from = *least, range = std::max(*most - *least, 1e-9);
  std::vector<std::uint8_t> out;
  out.reserve(sum.size());
  for (const double value : sum)
    out.push_back(static_cast<std::uint8_t>(std::lround(255 * (value - from) / range)));
  return out;
}

NoiseTexture::NoiseTexture() : texture_(GlTexture::make()) {
  const std::vector<std::uint8_t> clouds = repeating_noise(kSide, kCloudCells, kCloudSeed);
  const std::vector<std::uint8_t> tints = repeating_noise(kSide, kTintCells, kTintSeed);
  std::vector<std::uint8_t> texels;
  texels.reserve(2 * clouds.size());
  for (std::size_t i = 0; i < clouds.size(); ++i)
    texels.insert(texels.end(), {clouds[i], with_contrast(tints[i])});
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG8, kSide, kSide, 0, GL_RG, GL_UNSIGNED_BYTE, texels.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
}

void NoiseTexture::bind(const GlProgram& program, GLint unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glUniform1i(glGetUniformLocation(program.get(), "noise"), unit);
}

}  // namespace runstone
