#include "bench/wire/packed_longs.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"

using namespace runstone;
using bench::PackedLongs;

TEST_CASE("packed numbers of any width are read back, and lie at Minecraft's positions",
          "[storage]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (unsigned bits = 1; bits <= 16; ++bits) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{512}, PackedLongs::kCountMax}) {
      CAPTURE(Catch::rngSeed(), bits, count);
      std::vector<std::uint32_t> plain(count);
      for (std::uint32_t& value : plain) value = rng.below(1u << bits);
      PackedLongs packed(count, bits);
      packed.assign([&](std::size_t i) { return plain[i]; });
      const std::size_t per_long = 64 / bits;
      REQUIRE(packed.longs().size() == (count + per_long - 1) / per_long);
      for (int step = 0; step < 500; ++step) {
        const std::size_t i = rng.below(static_cast<std::uint32_t>(count));
        plain[i] = rng.below(1u << bits);
        packed.set(i, plain[i]);
      }
      std::vector<std::uint32_t> walked;
      packed.for_each([&](std::uint32_t value) { walked.push_back(value); });
      REQUIRE(walked == plain);
      for (std::size_t i = 0; i < count; ++i) {
        REQUIRE(packed[i] == plain[i]);
        const std::uint64_t word = packed.longs()[i / per_long];
        REQUIRE((word >> (i % per_long * bits) & ((1u << bits) - 1)) == plain[i]);
      }
    }
  }
}

TEST_CASE("a palette has no bits for one material, and at least four for more", "[storage]") {
  CHECK(bench::palette_bits(1) == 0);
  CHECK(bench::palette_bits(2) == 4);
  CHECK(bench::palette_bits(16) == 4);
  CHECK(bench::palette_bits(17) == 5);
  CHECK(bench::palette_bits(256) == 8);
  CHECK(bench::palette_bits(257) == 9);
}
