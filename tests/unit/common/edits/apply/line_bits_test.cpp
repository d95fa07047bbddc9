#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/edits/apply/line_bits.hpp"

namespace runstone::test {

TEST_CASE("bits between two positions are exactly those", "[edits]") {
  for (std::uint32_t first = 0; first <= kSideMax; ++first) {
    for (std::uint32_t last = first; last <= kSideMax; ++last) {
      const auto bits = bits_between(first, last).to_bitset();
      REQUIRE(bits.count() == last - first);
      for (std::uint32_t i = first; i < last; ++i) REQUIRE(bits.test(i));
      REQUIRE(bits_between(first, last).lowest() == (first == last ? 128 : first));
    }
  }
}

TEST_CASE("wide comparison of lines equals the plain one", "[edits]") {
  SplitMix64 rng{41};
  std::array<Material, kSideMax + 16> a{};
  std::array<Material, kSideMax + 16> b{};
  for (int round = 0; round < 2000; ++round) {
    const std::uint32_t variety = 1 + rng.below(3);
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = static_cast<Material>(rng.below(variety) * 0x8001u);
      b[i] = static_cast<Material>(rng.below(variety) * 0x8001u);
    }
    const std::uint32_t count = 1 + rng.below(kSideMax);
    const LineBits bits = differing(a.data(), b.data(), count);
    REQUIRE(bits == differing_plain(a.data(), b.data(), count));
    for (std::uint32_t i = 0; i < kSideMax; ++i) {
      REQUIRE(bits.to_bitset().test(i) == (i < count && a[i] != b[i]));
    }
  }
}

}  // namespace runstone::test
