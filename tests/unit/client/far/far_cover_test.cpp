#include "client/far/far_cover.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "tests/unit/client/far/cover_model.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("a child takes the place of its octant, and gives it back when it leaves", "[far]") {
  FarCover cover;
  const ChunkKey tile{1, {0, 0, 0}};
  const ChunkKey chunk = tile_child(tile, 3);
  cover.put(tile, true);
  CHECK(cover.parts(tile) == TileParts{true, 0});
  cover.put(chunk, true);
  CHECK(cover.parts(tile) == TileParts{false, 0b1111'0111});
  CHECK(cover.shows(chunk));
  cover.remove(chunk);
  CHECK(cover.parts(tile) == TileParts{true, 0});
  CHECK_FALSE(cover.shows(chunk));
  cover.remove(tile);
  CHECK(cover.parts(tile) == TileParts{});
}

TEST_CASE("a tile without octants hides what is below it until it gets them", "[far]") {
  FarCover cover;
  const ChunkKey top{2, {-1, 0, 0}};
  const ChunkKey tile = tile_child(top, 0), chunk = tile_child(tile, 7);
  cover.put(chunk, true);
  cover.put(tile, true);
  CHECK(cover.shows(chunk));
  cover.put(top, false);
  CHECK(cover.parts(top) == TileParts{true, 0});
  CHECK_FALSE(cover.shows(chunk));
  CHECK(cover.parts(tile) == TileParts{});
  cover.put(top, true);
  CHECK(cover.parts(top) == TileParts{false, 0b1111'1110});
  CHECK(cover.parts(tile) == TileParts{false, 0b0111'1111});
  CHECK(cover.shows(chunk));
}

TEST_CASE("below a gap the octant of the tile above is drawn", "[far]") {
  FarCover cover;
  const ChunkKey top{2, {0, 0, 0}};
  const ChunkKey tile = tile_child(top, 0), chunk = tile_child(tile, 7);
  cover.put(top, true);
  cover.put(chunk, true);
  CHECK_FALSE(cover.shows(chunk));
  CHECK(cover.parts(top) == TileParts{true, 0});
  cover.put(tile, true);
  CHECK(cover.shows(chunk));
  CHECK(cover.parts(top) == TileParts{false, 0b1111'1110});
  cover.remove(tile);
  CHECK_FALSE(cover.shows(chunk));
}

TEST_CASE("all ground that is known is drawn exactly once, whatever comes and goes",
          "[far][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  CoverModel model{{3, {-1, 0, 2}}};
  FarCover cover;
  for (int step = 0; step < 6'000; ++step) {
    const ChunkCoord first = first_chunk(model.top);
    const auto within = [&] { return static_cast<std::int32_t>(rng.below(8)); };
    const auto lod = static_cast<std::uint8_t>(rng.below(4));
    const ChunkKey key = tile_of({first.x + within(), first.y + within(), first.z + within()}, lod);
    // Long phases of growth and of decay reach full and empty trees.
    const bool is_growing = step / 500 % 2 == 0;
    if (rng.below(10) < (is_growing ? 8U : 2U)) {
      cover.put(key, rng.below(4) != 0);
      model.present.insert(key);
    } else {
      cover.remove(key);
      model.present.erase(key);
    }
    if (step % 7 != 0) continue;
    CAPTURE(Catch::rngSeed(), step);
    REQUIRE(model.faults(cover).empty());
  }
}

TEST_CASE("the model finds a chunk that is drawn besides its octant", "[far]") {
  FarCover cover;
  CoverModel model{{1, {0, 0, 0}}};
  cover.put(model.top, true);
  model.present = {model.top, {0, {0, 0, 0}}};
  CHECK(model.faults(cover).empty());
  FarCover other;
  other.put({0, {0, 0, 0}}, true);
  CHECK(model.faults(other).size() == 7);
}
