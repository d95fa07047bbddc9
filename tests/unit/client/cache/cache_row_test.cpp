#include "client/cache/cache_row.hpp"

#include <catch2/catch.hpp>

#include "client/cache/cache_drops.hpp"
#include "common/core/hash.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test::cache_row_test {
namespace {

constexpr unsigned kEdge = 16;
constexpr ChunkKey kKey{1, {4, -5, 6}};

CachedWorld some_world() {
  CachedWorld world;
  world.id = {7};
  world.chunk_edge = kEdge;
  world.mark = {3, 90, 100};
  world.tile_rules = 5;
  return world;
}

Chunk some_chunk() {
  SplitMix64 rng{5};
  Chunk chunk;
  chunk.voxels = random_chunk(rng, Extent::cube(kEdge), AxisOrder::yxz, 30);
  chunk.digest = digest_of(chunk.voxels);
  chunk.version = {3, 80};
  return chunk;
}

}  // namespace

TEST_CASE("a record of the cache gives the chunk that was stored", "[cache]") {
  const CachedWorld world = some_world();
  const Chunk chunk = some_chunk();
  const Bytes record = record_of(world.id, kKey, chunk);
  const ChunkPtr found = chunk_of_record(world, kKey, record);
  REQUIRE(found);
  CHECK(*found == chunk);
  CachedWorld other = world;
  other.id = {8};
  CHECK_FALSE(chunk_of_record(other, kKey, record));
  CHECK_FALSE(chunk_of_record(world, {0, kKey.at}, record));
  CHECK_FALSE(chunk_of_record(world, {kKey.lod, {4, -5, 7}}, record));
  other = world;
  other.chunk_edge = 32;
  CHECK_FALSE(chunk_of_record(other, kKey, record));
}

TEST_CASE("a record with one wrong bit, a byte less or a byte more is refused", "[cache]") {
  const CachedWorld world = some_world();
  const Bytes record = record_of(world.id, kKey, some_chunk());
  for (std::size_t i = 0; i < 8 * record.size(); ++i) {
    Bytes damaged = record;
    damaged[i / 8] ^= static_cast<std::uint8_t>(1U << (i % 8));
    CAPTURE(i);
    REQUIRE_FALSE(chunk_of_record(world, kKey, damaged));
  }
  for (std::size_t size = 0; size < record.size(); ++size)
    REQUIRE_FALSE(chunk_of_record(world, kKey, ByteView(record).first(size)));
  Bytes longer = record;
  longer.push_back(0);
  CHECK_FALSE(chunk_of_record(world, kKey, longer));
}

TEST_CASE("what a cache drops follows from the two descriptions of a world", "[cache]") {
  const CachedWorld before = some_world();
  CachedWorld now = before;
  now.mark = {3, 95, 120};
  CHECK_FALSE(drops_of(before, now).any());
  now.mark = {4, 500, 500};  // a new epoch
  const CacheDrops lost = drops_of(before, now);
  CHECK(lost.lost);
  CHECK(lost.common == 90);
  CHECK(lost.epoch == 4);
  CHECK_FALSE((lost.all || lost.edited || lost.tiles));
  now.mark = {4, 80, 80};  // edits that were durable are gone
  CHECK(drops_of(before, now).edited);
  now = before;
  now.tile_rules = 6;
  CHECK(drops_of(before, now).tiles);
  now.tile_rules = 0;  // this connection has no tiles
  CHECK_FALSE(drops_of(before, now).any());
  now.chunk_edge = 32;
  CHECK(drops_of(before, now).all);
}

}  // namespace runstone::test::cache_row_test
