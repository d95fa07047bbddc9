#include "bench/storage/morton_code.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"

using namespace runstone;
using namespace runstone::bench::storage;

namespace {

/// Interleaves the coordinates bit by bit, as the oracle.
std::uint32_t interleaved(LocalPos at) {
  std::uint32_t out = 0;
  for (unsigned bit = 0; bit < 7; ++bit) {
    if (at.x & 1u << bit) out += 1u << (3 * bit);
    if (at.y & 1u << bit) out += 2u << (3 * bit);
    if (at.z & 1u << bit) out += 4u << (3 * bit);
  }
  return out;
}

}  // namespace

TEST_CASE("a Morton code has the bits of x, y and z in turns", "[storage]") {
  SplitMix64 rng{Catch::rngSeed()};
  CHECK(MortonByTable::code({1, 0, 0}) == 1);
  CHECK(MortonByTable::code({0, 1, 0}) == 2);
  CHECK(MortonByTable::code({0, 0, 1}) == 4);
  CHECK(MortonByTable::code({127, 127, 127}) == 128 * 128 * 128 - 1);
  for (int step = 0; step < 2000; ++step) {
    const auto along = [&] { return static_cast<std::uint8_t>(rng.below(128)); };
    const std::uint8_t x = along(), y = along();
    const LocalPos at = {x, y, along()};
    REQUIRE(MortonByTable::code(at) == interleaved(at));
    if (morton_by_pdep()) REQUIRE(MortonByPdep::code(at) == interleaved(at));
    const auto up = [](std::uint8_t a) { return static_cast<std::uint8_t>((a + 1) % 128); };
    REQUIRE(morton_next(interleaved(at), kMortonAxis[0]) == interleaved({up(at.x), at.y, at.z}));
    REQUIRE(morton_next(interleaved(at), kMortonAxis[1]) == interleaved({at.x, up(at.y), at.z}));
    REQUIRE(morton_next(interleaved(at), kMortonAxis[2]) == interleaved({at.x, at.y, up(at.z)}));
  }
}
