#include "client/render/noise_texture.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>

using namespace runstone;

TEST_CASE("noise uses all values and continues from each side into the other", "[render]") {
  constexpr unsigned kNoiseSide = 128;
  const auto noise = repeating_noise(kNoiseSide, 8, 5);
  REQUIRE(noise.size() == std::size_t{kNoiseSide} * kNoiseSide);
  CHECK(*std::ranges::min_element(noise) == 0);
  CHECK(*std::ranges::max_element(noise) == 255);
  const auto at = [&](unsigned x, unsigned y) {
    return int{noise[std::size_t{y % kNoiseSide} * kNoiseSide + x % kNoiseSide]};
  };
  int most_inside = 0, most_across = 0;
  for (unsigned i = 0; i < kNoiseSide; ++i) {
    for (unsigned j = 0; j + 1 < kNoiseSide; ++j) {
      most_inside = std::max(
          {most_inside, std::abs(at(j, i) - at(j + 1, i)), std::abs(at(i, j) - at(i, j + 1))});
    }
    most_across = std::max({most_across, std::abs(at(kNoiseSide - 1, i) - at(0, i)),
                            std::abs(at(i, kNoiseSide - 1) - at(i, 0))});
  }
  CHECK(most_across <= most_inside);
  CHECK(most_inside < 64);
  CHECK(repeating_noise(kNoiseSide, 8, 5) == noise);
  CHECK(repeating_noise(kNoiseSide, 8, 6) != noise);
}
