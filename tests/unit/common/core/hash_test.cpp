#include "common/core/hash.hpp"

#include <catch2/catch.hpp>

#include "common/core/ids.hpp"

using namespace runstone;

TEST_CASE("the seeded stream is SplitMix64 with its published numbers", "[core][hash]") {
  SplitMix64 rng(1234567);
  CHECK(rng.next() == 6457827717110365317ULL);
  CHECK(rng.next() == 3203168211198807973ULL);
  CHECK(rng.next() == 9817491932198370423ULL);
}

TEST_CASE("bounded draws stay in range and reach both ends", "[core][hash]") {
  SplitMix64 rng(5);
  bool low = false;
  bool high = false;
  for (int i = 0; i < 2000; ++i) {
    CHECK(rng.below(1) == 0);
    const std::int32_t v = rng.between(-3, 3);
    REQUIRE(v >= -3);
    REQUIRE(v <= 3);
    low = low || v == -3;
    high = high || v == 3;
  }
  CHECK(low);
  CHECK(high);
  CHECK(rng.between(-7, -7) == -7);
}

TEST_CASE("versions compare by epoch first", "[core][ids]") {
  CHECK(Version{1, 900} < Version{2, 1});
  CHECK(Version{2, 1} < Version{2, 2});
  CHECK(Version{} < Version{1, 0});
}
