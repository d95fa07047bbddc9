#include "client/far/stand_in.hpp"

#include <catch2/catch.hpp>

#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("a stand-in has the voxels of its octant, twice as wide", "[far][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  CAPTURE(Catch::rngSeed());
  for (int round = 0; round < 60; ++round) {
    const auto edge = static_cast<unsigned>(round % 3 == 0 ? 32 : 16);
    const RunChunk parent = random_chunk(rng, Extent::cube(edge), random_order(rng), 5);
    const auto octant = static_cast<unsigned>(rng.below(8));
    const RunChunk out = stand_in(parent, octant);
    REQUIRE(validate(out).has_value());
    REQUIRE(out.extent == parent.extent);
    for (int probe = 0; probe < 400; ++probe) {
      const auto local = [&] { return static_cast<std::uint8_t>(rng.below(edge)); };
      const LocalPos at{local(), local(), local()};
      const auto from = [&](std::uint8_t v, unsigned bit) {
        return static_cast<std::uint8_t>(v / 2U + (octant >> bit & 1U) * edge / 2U);
      };
      REQUIRE(material_at(out, at) ==
              material_at(parent, {from(at.x, 0), from(at.y, 1), from(at.z, 2)}));
    }
  }
}
