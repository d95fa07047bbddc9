#include "client/render/texture_levels.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <functional>

#include "client/render/texture_array.hpp"
#include "common/core/hash.hpp"

namespace runstone {
namespace {

using Pixel4 = std::array<std::uint8_t, 4>;

TexturePicture picture_of(std::uint16_t edge,
                          const std::function<Pixel4(unsigned x, unsigned y)>& pixel) {
  TexturePicture out{edge, {}};
  for (unsigned y = 0; y < edge; ++y) {
    for (unsigned x = 0; x < edge; ++x) {
      const Pixel4 rgba = pixel(x, y);
      out.rgba.insert(out.rgba.end(), rgba.begin(), rgba.end());
    }
  }
  return out;
}

Pixel4 pixel_of(const std::vector<std::uint8_t>& level, std::size_t i) {
  return {level[4 * i], level[4 * i + 1], level[4 * i + 2], level[4 * i + 3]};
}

/// Returns the share of a level in which the alpha of the nearest four pixels, mixed, is a half.
double share_of_solid(const std::vector<std::uint8_t>& level, std::size_t edge) {
  constexpr std::size_t kSteps = 8;
  const auto alpha = [&](std::size_t x, std::size_t y) {
    return static_cast<double>(level[(y % edge * edge + x % edge) * 4 + 3]) / 255;
  };
  std::size_t solid = 0;
  for (std::size_t y = 0; y < edge * kSteps; ++y) {
    for (std::size_t x = 0; x < edge * kSteps; ++x) {
      const double right = (static_cast<double>(x % kSteps) + 0.5) / kSteps;
      const double down = (static_cast<double>(y % kSteps) + 0.5) / kSteps;
      const std::size_t i = x / kSteps, j = y / kSteps;
      const double mixed = (alpha(i, j) * (1 - right) + alpha(i + 1, j) * right) * (1 - down) +
                           (alpha(i, j + 1) * (1 - right) + alpha(i + 1, j + 1) * right) * down;
      solid += mixed >= 0.5 ? 1 : 0;
    }
  }
  return static_cast<double>(solid) / static_cast<double>(edge * edge * kSteps * kSteps);
}

}  // namespace

TEST_CASE("a picture without holes is its own first level, and the last one is its mean",
          "[textures]") {
  // Every value of a colour is in it.
  const TexturePicture picture = picture_of(16, [](unsigned x, unsigned y) {
    const auto v = static_cast<std::uint8_t>(16 * y + x);
    return Pixel4{v, static_cast<std::uint8_t>(255 - v), v, 255};
  });
  const TextureLevels levels = texture_levels(picture);
  REQUIRE(levels.levels.size() == 5);
  CHECK(levels.edge == 16);
  CHECK(levels.levels[0] == picture.rgba);
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(levels.levels[i].size() == (std::size_t{256} >> (2 * i)) * 4);
  const TextureLevels squares = texture_levels(picture_of(32, [](unsigned x, unsigned y) {
    return (x + y) % 2 == 0 ? Pixel4{255, 255, 255, 255} : Pixel4{0, 0, 0, 255};
  }));
  // Half of the light of white is brighter than the mean of the bytes.
  for (std::size_t i = 1; i < 6; ++i)
    CHECK(pixel_of(squares.levels[i], 0) == Pixel4{188, 188, 188, 255});
}

TEST_CASE("holes get the mean colour, and their own colour does not reach other pixels",
          "[textures]") {
  const TextureLevels levels = texture_levels(picture_of(16, [](unsigned x, unsigned) {
    return x < 8 ? Pixel4{200, 40, 10, 255} : Pixel4{0, 255, 0, 0};
  }));
  for (const auto& level : levels.levels) {
    for (std::size_t i = 0; i < level.size() / 4; ++i) {
      const Pixel4 pixel = pixel_of(level, i);
      CHECK(std::abs(pixel[0] - 200) <= 1);
      CHECK(std::abs(pixel[1] - 40) <= 1);
    }
  }
  CHECK(levels.levels[0][3] == 255);
  CHECK(levels.levels[0][4 * 15 + 3] == 0);
}

TEST_CASE("each level has about the share of holes of the picture", "[textures]") {
  for (const std::uint64_t percent : {10U, 30U, 50U}) {
    std::size_t solid = 0;
    const TextureLevels levels = texture_levels(picture_of(64, [&](unsigned x, unsigned y) {
      const bool is_solid = mix64(x / 2 * 1000 + y / 2) % 100 < percent;
      solid += is_solid ? 1 : 0;
      return is_solid ? Pixel4{90, 160, 40, 255} : Pixel4{0, 0, 0, 0};
    }));
    const double share = static_cast<double>(solid) / (64 * 64);
    for (std::size_t i = 1; i < levels.levels.size(); ++i) {
      const std::size_t edge = std::size_t{64} >> i;
      CAPTURE(percent, edge, share);
      CHECK(share_of_solid(levels.levels[i], edge) > share - 0.08);
      // Small levels have too few pixels for a small share.
      if (edge >= 8) CHECK(share_of_solid(levels.levels[i], edge) < share + 0.12);
    }
  }
  const TextureLevels empty =
      texture_levels(picture_of(16, [](unsigned, unsigned) { return Pixel4{9, 9, 9, 0}; }));
  CHECK(empty.levels.back()[3] == 0);
}

TEST_CASE("a layer of a larger array repeats the pixels of a picture", "[textures]") {
  const TexturePicture picture = picture_of(16, [](unsigned x, unsigned y) {
    return Pixel4{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 0, 255};
  });
  const TextureLevels levels = texture_levels(picture);
  const auto large = layer_pixels(levels, 64);
  REQUIRE(large.size() == 64 * 64 * 4);
  for (const std::size_t y : {0U, 3U, 4U, 63U}) {
    for (const std::size_t x : {0U, 3U, 4U, 62U}) {
      const Pixel4 pixel = pixel_of(large, y * 64 + x);
      CHECK(pixel[0] == x / 4);
      CHECK(pixel[1] == y / 4);
    }
  }
  CHECK(layer_pixels(levels, 16) == picture.rgba);
  CHECK(layer_pixels(levels, 4) == levels.levels[2]);
  CHECK(layer_pixels(levels, 1) == levels.levels[4]);
}

}  // namespace runstone
