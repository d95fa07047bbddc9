#include "client/render/range_allocator.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

TEST_CASE("ranges never overlap, and freed ranges join", "[render]") {
  RangeAllocator ranges;
  ranges.grow(1000);
  struct Range {
    std::uint32_t first, count;
  };
  std::vector<Range> taken;
  std::vector<bool> used(1000);
  SplitMix64 rng(11);
  for (int step = 0; step < 5000; ++step) {
    if (!taken.empty() && rng.below(2) == 0) {
      const auto at = taken.begin() + rng.below(static_cast<std::uint32_t>(taken.size()));
      std::fill_n(used.begin() + at->first, at->count, false);
      ranges.give_back(at->first, at->count);
      taken.erase(at);
      continue;
    }
    const std::uint32_t count = 1 + rng.below(60);
    const auto first = ranges.take(count);
    if (!first) continue;
    REQUIRE(*first + count <= 1000);
    for (std::uint32_t i = *first; i < *first + count; ++i) {
      REQUIRE_FALSE(used[i]);
      used[i] = true;
    }
    taken.push_back({*first, count});
  }
  for (const Range& range : taken) ranges.give_back(range.first, range.count);
  CHECK(ranges.used() == 0);
  CHECK(ranges.take(1000) == 0U);
  CHECK_FALSE(ranges.take(1).has_value());
  ranges.grow(1001);
  CHECK(ranges.take(1) == 1000U);
}

TEST_CASE("a range is taken from the smallest free one that holds it", "[render]") {
  RangeAllocator ranges;
  ranges.grow(100);
  REQUIRE(ranges.take(30) == 0U);
  REQUIRE(ranges.take(10) == 30U);
  REQUIRE(ranges.take(20) == 40U);
  REQUIRE(ranges.take(5) == 60U);
  ranges.give_back(0, 30);
  ranges.give_back(40, 20);
  CHECK(ranges.take(15) == 40U);  // not from the 30 or the 35 at the end
  CHECK(ranges.take(5) == 55U);
  CHECK(ranges.take(31) == 65U);
  CHECK(ranges.take(30) == 0U);
}
