#include "client/schedule/histogram.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

/// Returns the percentile by nearest rank of the sorted values.
std::int64_t exact(std::vector<std::int64_t> values, double share) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

TEST_CASE("percentiles are within one per cent of the exact ones", "[schedule]") {
  SplitMix64 rng{Catch::rngSeed() + 3};
  for (int round = 0; round < 40; ++round) {
    Histogram histogram;
    std::vector<std::int64_t> values;
    const std::uint32_t count = 1 + rng.below(3000);
    for (std::uint32_t i = 0; i < count; ++i) {
      // All magnitudes, so that every bucket width occurs.
      const auto value = static_cast<std::int64_t>(rng.next() >> (24 + rng.below(40)));
      values.push_back(value);
      histogram.add(value);
    }
    for (const double share : {0.001, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const std::int64_t truth = exact(values, share);
      CAPTURE(round, share, truth);
      REQUIRE(histogram.percentile(share).has_value());
      CHECK(std::abs(static_cast<double>(*histogram.percentile(share) - truth)) <=
            0.01 * static_cast<double>(truth));
    }
    CHECK(histogram.max() == exact(values, 1.0));
    CHECK(histogram.count() == count);
  }
}

TEST_CASE("values below 256 are exact", "[schedule]") {
  for (std::int64_t v = 0; v < 256; ++v) {
    Histogram histogram;
    histogram.add(v);
    CHECK(histogram.percentile(0.5) == v);
  }
}

TEST_CASE("infinite values count in the percentiles", "[schedule]") {
  Histogram histogram;
  CHECK_FALSE(histogram.percentile(0.5).has_value());
  CHECK_FALSE(histogram.max().has_value());
  for (int i = 0; i < 9; ++i) histogram.add(100);
  histogram.add_infinite();
  CHECK(histogram.count() == 10);
  CHECK(histogram.percentile(0.9) == 100);
  CHECK(histogram.percentile(0.91) == Histogram::kInfinite);
  CHECK(histogram.max() == Histogram::kInfinite);
  CHECK(histogram.mean() == 100.0);
}

TEST_CASE("negative and huge values are clamped, not dropped", "[schedule]") {
  Histogram histogram;
  histogram.add(-5);
  histogram.add(Histogram::kValueMax + 12345);
  CHECK(histogram.below_zero() == 1);
  CHECK(histogram.count() == 2);
  CHECK(histogram.percentile(0.5) == 0);
  CHECK(histogram.max() == Histogram::kValueMax);
}

TEST_CASE("merging is adding all values", "[schedule]") {
  Histogram a, b, both;
  for (int i = 0; i < 500; ++i) {
    (i % 3 == 0 ? a : b).add(i * i);
    both.add(i * i);
  }
  b.add_infinite();
  both.add_infinite();
  a.merge(b);
  for (const double share : {0.1, 0.5, 0.9, 1.0})
    CHECK(a.percentile(share) == both.percentile(share));
  CHECK(a.count() == both.count());
  CHECK(a.mean() == both.mean());
}

TEST_CASE("rows count every finite value once, with two rows per power of two", "[schedule]") {
  Histogram histogram;
  CHECK(histogram.rows().empty());
  for (const std::int64_t value : {0, 1, 2, 3, 4, 5, 6, 100, 70'000}) histogram.add(value);
  histogram.add_infinite();
  using Row = Histogram::Row;
  CHECK(histogram.rows() == std::vector<Row>{{0, 1, 1},
                                             {1, 2, 1},
                                             {2, 3, 1},
                                             {3, 4, 1},
                                             {4, 6, 2},
                                             {6, 8, 1},
                                             {96, 128, 1},
                                             {65'536, 98'304, 1}});
}

TEST_CASE("a value equal to a limit is in the row that begins there", "[schedule]") {
  for (std::int64_t power = 2; power < Histogram::kValueMax; power *= 2) {
    for (const std::int64_t limit : {power, power + power / 2}) {
      CAPTURE(limit);
      Histogram histogram;
      histogram.add(limit - 1);
      histogram.add(limit);
      const auto rows = histogram.rows();
      REQUIRE(rows.size() == 2);
      CHECK(rows[0].below == limit);
      CHECK(rows[1].from == limit);
      CHECK(rows[0].count == 1);
      CHECK(rows[1].count == 1);
    }
  }
  Histogram most;
  most.add(Histogram::kValueMax);
  REQUIRE(most.rows().size() == 1);
  CHECK(most.rows()[0].below == Histogram::kValueMax + 1);
}
