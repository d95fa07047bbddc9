#include "client/render/texture_levels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

struct Pixel {
  std::array<float, 3> light{};  // linear
  float alpha = 0;               // 0 .. 1
};
using Pixels = std::vector<Pixel>;

float linear_light(std::uint8_t srgb) {
  static const auto kTable = [] {
    std::array<float, 256> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
      const float c = static_cast<float>(i) / 255.0F;
      out[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
    }
    return out;
  }();
  return kTable[srgb];
}

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

std::uint8_t srgb_of(float light) {
  return byte_of(light <= 0.0031308F ? 12.92F * light
                                     : 1.055F * std::pow(light, 1 / 2.4F) - 0.055F);
}

Pixels pixels_of(const TexturePicture& picture) {
  Pixels out(picture.rgba.size() / 4);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) out[i].light[c] = linear_light(picture.rgba[4 * i + c]);
    out[i].alpha = static_cast<float>(picture.rgba[4 * i + 3]) / 255.0F;
  }
  return out;
}

/// Returns the mean of pixels, weighted with their alpha. Pixels without alpha count a little.
Pixel mean_of(std::span<const Pixel> pixels) {
  Pixel out;
  float weights = 0;
  for (const Pixel& pixel : pixels) {
    const float weight = pixel.alpha + 1e-4F;
    for (std::size_t c = 0; c < 3; ++c) out.light[c] += pixel.light[c] * weight;
    out.alpha += pixel.alpha;
    weights += weight;
  }
  for (float& light : out.light) light /= weights;
  out.alpha /= static_cast<float>(pixels.size());
  return out;
}

bool is_hole(const Pixel& pixel) { return byte_of(pixel.alpha) < kHoleAlpha; }

std::size_t solid_count(const Pixels& pixels) {
  return static_cast<std::size_t>(
      std::count_if(pixels.begin(), pixels.end(), [](const Pixel& p) { return !is_hole(p); }));
}

Pixels halved_pixels(const Pixels& pixels, std::size_t edge) {
  Pixels out;
  for (std::size_t y = 0; y < edge; y += 2) {
    for (std::size_t x = 0; x < edge; x += 2) {
      const std::size_t at = y * edge + x;
      const std::array<Pixel, 4> four = {pixels[at], pixels[at + 1], pixels[at + edge],
                                         pixels[at + edge + 1]};
      out.push_back(mean_of(four));
    }
  }
  return out;
}

/// Returns the share of a square picture that is no hole where the GPU mixes four pixels, if alpha
/// is multiplied with the factor.
double solid_share(const Pixels& pixels, std::size_t edge, float factor) {
  constexpr std::array<float, 2> kPlaces = {0.25F, 0.75F};  // between two pixels
  const auto alpha = [&](std::size_t x, std::size_t y) {
    return std::min(1.0F, pixels[y % edge * edge + x % edge].alpha * factor);
  };
  std::size_t solid = 0;
  for (std::size_t y = 0; y < edge; ++y) {
    for (std::size_t x = 0; x < edge; ++x) {
      for (const float right : kPlaces) {
        const float upper = std::lerp(alpha(x, y), alpha(x + 1, y), right);
        const float lower = std::lerp(alpha(x, y + 1), alpha(x + 1, y + 1), right);
        for (const float down : kPlaces) solid += std::lerp(upper, lower, down) >= 0.5F ? 1 : 0;
      }
    }
  }
  return static_cast<double>(solid) / static_cast<double>(4 * pixels.size());
}

/// Returns the least factor of alpha, 1 or more, with which at least this share is no hole.
float alpha_factor(const Pixels& pixels, std::size_t edge, double wanted) {
  constexpr float kFactorMax = 256;  // makes a pixel of any alpha solid
  constexpr int kSteps = 10;
  if (solid_share(pixels, edge, 1) >= wanted) return 1;
  float less = 1, enough = kFactorMax;
  for (int i = 0; i < kSteps; ++i) {
    const float between = std::sqrt(less * enough);
    (solid_share(pixels, edge, between) >= wanted ? enough : less) = between;
  }
  return enough;
}

std::vector<std::uint8_t> bytes_of(const Pixels& pixels, float factor) {
  std::vector<std::uint8_t> out;
  out.reserve(pixels.size() * 4);
  for (const Pixel& pixel : pixels) {
    for (const float light : pixel.light) out.push_back(srgb_of(light));
    out.push_back(byte_of(pixel.alpha * factor));
  }
  return out;
}

}  // namespace

TextureLevels texture_levels(const TexturePicture& picture) {
  RUNSTONE_ASSERT(std::has_single_bit(picture.edge));
  RUNSTONE_ASSERT(picture.rgba.size() == std::size_t{picture.edge} * picture.edge * 4);
  TextureLevels out;
  out.edge = picture.edge;
  Pixels pixels = pixels_of(picture);
  const Pixel mean = mean_of(pixels);
  for (Pixel& pixel : pixels) {
    if (is_hole(pixel)) pixel.light = mean.light;
  }
  const std::size_t solid = solid_count(pixels);
  const bool has_holes = solid != 0 && solid != pixels.size();
  const double wanted = static_cast<double>(solid) / static_cast<double>(pixels.size());
  out.levels.push_back(bytes_of(pixels, 1));
  for (std::size_t edge = picture.edge; edge > 1; edge /= 2) {
    pixels = halved_pixels(pixels, edge);
    out.levels.push_back(
        bytes_of(pixels, has_holes ? alpha_factor(pixels, edge / 2, wanted) : 1.0F));
  }
  return out;
}

}  // namespace runstone
