#include "server/tiles/tile_cache.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

MadeTile tile_at(std::int32_t x, Sequence through) {
  Chunk tile;
  tile.voxels = uniform_chunk(Extent::cube(16), 1);
  return {{1, {x, 0, 0}}, std::make_shared<const Chunk>(tile), through};
}

}  // namespace

TEST_CASE("a tile cache returns the tile that was put last under a key", "[tiles]") {
  TileCache cache(1 << 20);
  CHECK_FALSE(cache.find({1, {0, 0, 0}}).has_value());
  cache.put(tile_at(0, 3));
  const std::size_t bytes = cache.bytes();
  cache.put(tile_at(0, 4));
  CHECK(cache.bytes() == bytes);
  CHECK(cache.find({1, {0, 0, 0}})->through == 4);
  CHECK_FALSE(cache.find({2, {0, 0, 0}}).has_value());
}

TEST_CASE("a full tile cache drops the tiles that were not used for longest", "[tiles]") {
  TileCache probe(1 << 20);
  probe.put(tile_at(0, 0));
  TileCache cache(3 * probe.bytes());
  for (std::int32_t x = 0; x < 3; ++x) cache.put(tile_at(x, 0));
  CHECK(cache.find({1, {0, 0, 0}}).has_value());
  cache.put(tile_at(3, 0));
  CHECK(cache.bytes() == 3 * probe.bytes());
  CHECK_FALSE(cache.find({1, {1, 0, 0}}).has_value());
  for (const std::int32_t x : {0, 2, 3}) CHECK(cache.find({1, {x, 0, 0}}).has_value());
}

TEST_CASE("a tile that is larger than the cache is not kept", "[tiles]") {
  TileCache cache(1);
  cache.put(tile_at(0, 0));
  CHECK(cache.bytes() == 0);
}
