#include "common/generate/value_noise.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"

using namespace runstone;

TEST_CASE("noise stays within -1 and 1, uses much of it, and has no bias", "[generate]") {
  const ValueNoise noise(1, 0.05);
  double low = 1, high = -1, sum = 0;
  std::vector<double> plane(128 * 128);
  int count = 0;
  for (int x = -4; x < 4; ++x) {
    for (int z = -4; z < 4; ++z) {
      noise.fill(x * 128, z * 128, 128, 128, plane);
      for (const double v : plane) {
        low = std::min(low, v);
        high = std::max(high, v);
        sum += v;
        ++count;
      }
    }
  }
  CHECK(low >= -1);
  CHECK(high <= 1);
  CHECK(low < -0.75);
  CHECK(high > 0.75);
  CHECK(std::fabs(sum / count) < 0.03);
}

TEST_CASE("a column's noise does not depend on the rectangle that contains it", "[generate]") {
  SplitMix64 random(Catch::rngSeed());
  for (int round = 0; round < 40; ++round) {
    const double frequency = round % 4 == 0 ? 1.0 : random.between(1, 1000) / 1000.0;
    const ValueNoise noise(random.next(), frequency);
    const std::int32_t x = random.between(-kWorldLimit, kWorldLimit - 200);
    const std::int32_t z = random.between(-300, 300);
    const std::uint32_t width = 1 + random.below(128), depth = 1 + random.below(128);
    std::vector<double> plane(std::size_t{width} * depth);
    noise.fill(x, z, width, depth, plane);
    for (int probe = 0; probe < 50; ++probe) {
      const std::uint32_t i = random.below(width), k = random.below(depth);
      CAPTURE(frequency, x, z, i, k);
      REQUIRE(noise.at(x + static_cast<std::int32_t>(i), z + static_cast<std::int32_t>(k)) ==
              plane[i + width * k]);
    }
  }
}

TEST_CASE("noise is smooth: neighbouring columns differ by little at a low frequency",
          "[generate]") {
  const ValueNoise noise(3, 0.007);
  std::vector<double> line(128);
  noise.fill(-64, 5, 128, 1, line);
  // Bound of the slope: the fade's slope is at most 1.875, and a cell's rise at most 2. Each of the
  // three octaves has the weight 4/7 in the slope.
  for (std::size_t i = 1; i < line.size(); ++i) {
    CHECK(std::fabs(line[i] - line[i - 1]) <= 0.007 * 1.875 * 2 * 3 * 4 / 7);
  }
  CHECK(*std::max_element(line.begin(), line.end()) > *std::min_element(line.begin(), line.end()));
}

TEST_CASE("seeds give different noise", "[generate]") {
  const ValueNoise a(1, 0.01), b(2, 0.01);
  int equal = 0;
  for (std::int32_t x = 0; x < 100; ++x)
    equal += static_cast<int>(a.at(x * 50, 7) == b.at(x * 50, 7));
  CHECK(equal == 0);
}
