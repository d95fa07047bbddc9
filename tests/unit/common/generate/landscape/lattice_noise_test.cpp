#include "common/generate/landscape/lattice_noise.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "common/core/hash.hpp"

using namespace runstone;

TEST_CASE("noise is smooth, bounded and the same in its cell", "[generate][landscape]") {
  SplitMix64 random(3);
  for (const unsigned bits : {3U, 5U, 9U, 14U}) {
    const LatticeNoise noise(random.next(), bits);
    std::int32_t least = 0, most = 0;
    for (int i = 0; i < 4000; ++i) {
      const std::int32_t x = random.between(-600'000'000, 600'000'000);
      const std::int32_t z = random.between(-600'000'000, 600'000'000);
      const std::int32_t value = noise.at(x, z);
      least = std::min(least, value);
      most = std::max(most, value);
      if (std::abs(noise.at(x + 1, z) - value) > (kOne * 3 >> bits) + 3)
        FAIL_CHECK("a step at " << x << " " << z);
      // The cell of a block's first column is that of all its columns.
      const std::int32_t block_x = x & ~7, block_z = z & ~7;
      if (noise.in(noise.cell_of(block_x, block_z), x, z) != value)
        FAIL_CHECK("another cell at " << x << " " << z);
    }
    CHECK(least >= -kOne);
    CHECK(most <= kOne);
    CHECK(most - least > kOne);
  }
}

TEST_CASE("a fade goes from zero to one", "[generate][landscape]") {
  CHECK(fade_of(0) == 0);
  CHECK(fade_of(kOne) == kOne);
  CHECK(fade_of(kOne / 2) == kOne / 2);
  for (std::int32_t t = 0; t < kOne; ++t) {
    if (fade_of(t) > fade_of(t + 1)) FAIL_CHECK("it falls at " << t);
  }
}
