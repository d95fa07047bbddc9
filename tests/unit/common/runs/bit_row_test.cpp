#include "common/runs/bit_row.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"

namespace runstone {
namespace {

template <class Row>
Row random_row(SplitMix64& rng) {
  Row row = 0;
  for (unsigned bit = 0; bit < kRowBits<Row>; bit += 32) row |= Row{rng.below(~0u)} << bit;
  return row;
}

template <class Row>
void check_rows() {
  SplitMix64 rng(7);
  for (int round = 0; round < 50; ++round) {
    const Row row = random_row<Row>(rng);
    unsigned parity = 0;
    unsigned lowest = kRowBits<Row>;
    unsigned highest = 0;
    for (unsigned bit = 0; bit < kRowBits<Row>; ++bit) {
      const auto set = static_cast<unsigned>(row >> bit & 1);
      parity ^= set;
      REQUIRE(static_cast<unsigned>(prefix_xor(row) >> bit & 1) == parity);
      if (set == 0) continue;
      lowest = std::min(lowest, bit);
      highest = bit;
    }
    REQUIRE(row != 0);
    CHECK(lowest_bit(row) == lowest);
    CHECK(highest_bit(row) == highest);
  }
  for (unsigned count = 0; count <= kRowBits<Row>; ++count) {
    const Row below = bits_below<Row>(count);
    for (unsigned bit = 0; bit < kRowBits<Row>; ++bit)
      REQUIRE((below >> bit & 1) == (bit < count ? 1u : 0u));
  }
  std::array<Row, kRowBits<Row>> square;
  for (Row& row : square) row = random_row<Row>(rng);
  auto turned = square;
  transpose(turned);
  for (unsigned r = 0; r < kRowBits<Row>; ++r) {
    for (unsigned bit = 0; bit < kRowBits<Row>; ++bit) {
      REQUIRE((square[r] >> bit & 1) == (turned[bit] >> r & 1));
    }
  }
}

TEST_CASE("rows of all widths are searched, prefix-summed and transposed bit by bit", "[mesh]") {
  check_rows<Row32>();
  check_rows<Row64>();
  check_rows<Row128>();
}

}  // namespace
}  // namespace runstone
