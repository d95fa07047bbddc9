#include "client/far/far_fades.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr ChunkKey kTile{2, {1, 0, 0}}, kChunk{0, {3, 1, 2}};

}  // namespace

TEST_CASE("an octant dissolves or appears over the time of a fade, from the first frame on",
          "[far]") {
  FarFades fades;
  CHECK(fades.empty());
  REQUIRE(fades.begin(kChunk, true));
  REQUIRE(fades.begin(kTile, false));
  CHECK(fades.advance(100).empty());
  CHECK(fades.octant_gone(kChunk) == 0);
  CHECK(fades.octant_gone(kTile) == 1);
  float before = 0;
  for (double passed = kFadeSeconds / 7; passed < 0.9 * kFadeSeconds; passed += kFadeSeconds / 7) {
    CHECK(fades.advance(100 + passed).empty());
    CHECK(fades.octant_gone(kChunk) > before);
    before = fades.octant_gone(kChunk);
    CHECK(fades.octant_gone(kTile) == 1 - before);
  }
  CHECK(before > 0.7F);
  CHECK(before < 1);
  CHECK(fades.advance(100 + 1.1 * kFadeSeconds) == std::vector<ChunkKey>{kChunk, kTile});
  CHECK(fades.empty());
  CHECK(fades.octant_gone(kChunk) == 0);
}

TEST_CASE("a fade knows its direction, and ends if time goes back or it is ended", "[far]") {
  FarFades fades;
  REQUIRE(fades.begin(kChunk, true));
  REQUIRE(fades.begin(kTile, false));
  CHECK(fades.is_coming(kChunk));
  CHECK_FALSE(fades.is_leaving(kChunk));
  CHECK(fades.is_leaving(kTile));
  CHECK_FALSE(fades.is_coming(kTile));
  CHECK(fades.advance(3'599).empty());
  fades.end(kChunk);
  CHECK(fades.keys() == std::vector<ChunkKey>{kTile});
  CHECK(fades.advance(1) == std::vector<ChunkKey>{kTile});
}

TEST_CASE("fades are bounded", "[far]") {
  FarFades fades;
  for (std::size_t i = 0; i < kFadesMax; ++i)
    REQUIRE(fades.begin({0, {static_cast<std::int32_t>(i), 0, 0}}, true));
  CHECK_FALSE(fades.begin(kTile, true));
  CHECK(fades.begin({0, {0, 0, 0}}, false));  // one that is there may change its direction
}
