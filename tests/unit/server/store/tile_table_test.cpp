// Tiles in the store: written, read, made stale by snapshots, damaged, and absent in old worlds.
#include "server/store/tile_table.hpp"

#include <catch2/catch.hpp>

#include "common/core/tile_keys.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/store.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

using KeyedChunks = std::vector<std::pair<ChunkKey, ChunkPtr>>;
using Keys = std::vector<std::pair<ChunkKey, Version>>;

/// A world with 20 edits of epoch 1.
struct TiledWorld {
  TiledWorld() {
    REQUIRE(store->raise_epoch().has_value());
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    REQUIRE(store->append(players, sample_records(rng, 1, 1, 20)).has_value());
  }
  void save_tile(const ChunkKey& key, Version version) {
    const KeyedChunks tiles = {{key, sample_chunk(rng, version)}};
    REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
  }
  void save_snapshot(ChunkCoord at, Version version) {
    const KeyedChunks chunks = {{{0, at}, sample_chunk(rng, version)}};
    REQUIRE(store->save_snapshots(chunks, std::nullopt).has_value());
  }
  std::string file() { return place / "world.sqlite"; }

  SplitMix64 rng{4};
  TempPlace place;
  std::unique_ptr<Store> store = *create_world(place.path(), sample_meta());
};

/// Takes from a closed world what format 4 added.
void make_format_3(const std::string& file) {
  REQUIRE(raw_sql(file, "DROP TABLE tile; PRAGMA user_version = 3; SELECT 'done'") == "done");
}

}  // namespace

TEST_CASE("tiles are read as they were written, and a later one replaces an earlier one",
          "[store][tiles]") {
  TiledWorld world;
  KeyedChunks tiles = {{{1, {0, -1, 2}}, sample_chunk(world.rng, {1, 3})},
                       {{8, {0, 0, -1}}, sample_chunk(world.rng, {0, 0})}};
  REQUIRE(world.store->save_tiles(tiles, kTileRules).has_value());
  CHECK(**world.store->load_tile(tiles[0].first, kTileRules) == *tiles[0].second);
  CHECK(**world.store->load_tile(tiles[1].first, kTileRules) == *tiles[1].second);
  CHECK_FALSE(world.store->load_tile({2, {0, -1, 2}}, kTileRules)->has_value());
  CHECK(*world.store->tile_keys(kTileRules) ==
        Keys{{{1, {0, -1, 2}}, {1, 3}}, {{8, {0, 0, -1}}, {0, 0}}});

  tiles = {{{1, {0, -1, 2}}, sample_chunk(world.rng, {1, 9})}};
  REQUIRE(world.store->save_tiles(tiles, kTileRules).has_value());
  CHECK(**world.store->load_tile(tiles[0].first, kTileRules) == *tiles[0].second);
  CHECK(world.store->check().has_value());
}

TEST_CASE("a snapshot deletes the tiles above it that are older", "[store][tiles]") {
  TiledWorld world;
  world.save_tile(tile_of({-5, 3, 6}, 1), {1, 4});
  world.save_tile(tile_of({-5, 3, 6}, 2), {1, 7});
  world.save_tile(tile_of({-5, 3, 6}, 3), {1, 8});
  world.save_tile(tile_of({-5, 3, 6}, 8), {0, 30});  // an older epoch
  world.save_tile({1, {7, 7, 7}}, {1, 1});
  world.save_snapshot({-5, 3, 6}, {1, 7});
  CHECK(*world.store->tile_keys(kTileRules) == Keys{{{1, {7, 7, 7}}, {1, 1}},
                                                    {tile_of({-5, 3, 6}, 2), {1, 7}},
                                                    {tile_of({-5, 3, 6}, 3), {1, 8}}});
}

TEST_CASE("a tile that was made before a newer snapshot below it is left out", "[store][tiles]") {
  TiledWorld world;
  world.save_snapshot({0, 0, 0}, {1, 7});
  const KeyedChunks tiles = {{{1, {0, 0, 0}}, sample_chunk(world.rng, {1, 6})},
                             {{2, {0, 0, 0}}, sample_chunk(world.rng, {1, 7})},
                             {{1, {1, 0, 0}}, sample_chunk(world.rng, {1, 6})}};
  REQUIRE(world.store->save_tiles(tiles, kTileRules).has_value());
  CHECK(*world.store->tile_keys(kTileRules) ==
        Keys{{{1, {1, 0, 0}}, {1, 6}}, {{2, {0, 0, 0}}, {1, 7}}});
}

TEST_CASE("a tile that cannot be stored is refused, and nothing is written", "[store][tiles]") {
  TiledWorld world;
  KeyedChunks tiles = {{{1, {0, 0, 0}}, sample_chunk(world.rng, {1, 6})}};
  SECTION("it is ahead of the log") {
    tiles.emplace_back(ChunkKey{1, {1, 0, 0}}, sample_chunk(world.rng, {1, 21}));
  }
  SECTION("it is a chunk") {
    tiles.emplace_back(ChunkKey{0, {1, 0, 0}}, sample_chunk(world.rng, {1, 6}));
  }
  SECTION("its level is too high") {
    tiles.emplace_back(ChunkKey{kTileLevelMax + 1, {1, 0, 0}}, sample_chunk(world.rng, {1, 6}));
  }
  SECTION("its digest is wrong") {
    Chunk wrong = *sample_chunk(world.rng, {1, 6});
    wrong.digest = wrong.digest + Digest{{1, 1}};
    tiles.emplace_back(ChunkKey{1, {1, 0, 0}}, std::make_shared<const Chunk>(wrong));
  }
  const auto saved = world.store->save_tiles(tiles, kTileRules);
  REQUIRE_FALSE(saved.has_value());
  CHECK(saved.error().kind == StoreError::Kind::bad_request);
  CHECK(world.store->tile_keys(kTileRules)->empty());
}

TEST_CASE("a damaged column of a tile is an error that names file, table and tile",
          "[store][tiles][damage][sqlite]") {
  TiledWorld world;
  world.save_tile({2, {1, -2, 3}}, {1, 5});
  for (const char* change :
       {"epoch = 2", "seq = 6", "digest0 = digest0 + 1", "digest1 = 0", "checksum = checksum + 1",
        "data = zeroblob(4)", "data = CAST(data || x'00' AS BLOB)"}) {
    CAPTURE(change);
    world.save_tile({2, {1, -2, 3}}, {1, 5});
    REQUIRE(raw_sql(world.file(),
                    std::string("UPDATE tile SET ") + change + "; SELECT changes()") == "1");
    const auto loaded = world.store->load_tile({2, {1, -2, 3}}, kTileRules);
    REQUIRE_FALSE(loaded.has_value());
    CHECK(loaded.error().kind == StoreError::Kind::corrupt);
    CHECK(loaded.error().file == world.file());
    CHECK(loaded.error().where == "tile chunk=1,-2,3 lod=2");
  }
}

TEST_CASE("an import of base chunks and an accepted loss delete all tiles", "[store][tiles]") {
  SECTION("import") {
    TempPlace place;
    const auto store = *create_world(place.path(), sample_meta());
    SplitMix64 rng(5);
    const KeyedChunks tiles = {{{1, {0, 0, 0}}, sample_chunk(rng, {})}};
    REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
    const KeyedChunks base = {{{0, {9, 9, 9}}, sample_chunk(rng, {})}};
    REQUIRE(store->save_base(base).has_value());
    CHECK(store->tile_keys(kTileRules)->empty());
  }
  SECTION("loss") {
    TiledWorld world;
    world.save_tile({1, {0, 0, 0}}, {1, 6});
    REQUIRE(world.store->accept_losses().has_value());
    CHECK(world.store->tile_keys(kTileRules)->empty());
  }
}

TEST_CASE("a compaction deletes the tiles that are older than the snapshots it makes",
          "[store][tiles]") {
  TiledWorld world;
  world.save_snapshot({0, 0, 0}, {1, 3});
  world.save_tile({1, {0, 0, 0}}, {1, 3});
  world.save_tile({2, {0, 0, 0}}, {1, 20});
  world.save_tile({1, {4, 0, 0}}, {1, 3});
  const KeyedChunks kept = {{{0, {0, 0, 0}}, sample_chunk(world.rng, {1, 20})}};
  const Keyframe keyframe{{{1, 20}, 1'700'000'000'020'000},
                          1,
                          world_digest_term(kept.front().first, kept.front().second->digest)};
  REQUIRE(world.store->save_keyframe(kept, keyframe).has_value());
  const auto compacted = world.store->compact(20);
  if (!compacted) FAIL(compacted.error().message());
  CHECK(*world.store->tile_keys(kTileRules) ==
        Keys{{{1, {4, 0, 0}}, {1, 3}}, {{2, {0, 0, 0}}, {1, 20}}});
}

TEST_CASE("tiles of other rules are not there for a reader, and a writer deletes them",
          "[store][tiles][sqlite]") {
  // A world of format 4, one that is as it was, and one of format 5 that lost the row.
  const char* const changes[] = {
      "DELETE FROM meta WHERE key = 'tile_rules'; PRAGMA user_version = 4; SELECT 'done'", nullptr,
      "DELETE FROM meta WHERE key = 'tile_rules'; SELECT 'done'"};
  for (const char* const change : changes) {
    TiledWorld world;
    world.save_tile({1, {0, 0, 0}}, {1, 6});
    world.store.reset();
    const std::string file = world.file();
    if (change != nullptr) REQUIRE(raw_sql(file, change) == "done");
    const std::size_t left = change != nullptr ? 0 : 1;
    {
      const auto reader = *open_world(world.place.path(), StoreAccess::read_only);
      CHECK(reader->tile_keys(kTileRules)->size() == left);
      CHECK(reader->load_tile({1, {0, 0, 0}}, kTileRules)->has_value() == (left == 1));
    }
    CHECK(raw_sql(file, "SELECT count(*) FROM tile") == "1");  // a reader deletes nothing
    world.store = *open_world(world.place.path(), StoreAccess::read_write);
    CHECK(world.store->tile_keys(kTileRules)->size() == left);
    CHECK(raw_sql(file, "SELECT value FROM meta WHERE key = 'tile_rules'") ==
          std::to_string(kTileRules));
    CHECK(raw_sql(file, "PRAGMA user_version") == "5");
    CHECK(world.store->check().has_value());
  }
}

TEST_CASE("a world of format 3 has no tiles for a reader, and gets the table from a writer",
          "[store][tiles][sqlite]") {
  TiledWorld world;
  world.save_tile({1, {0, 0, 0}}, {1, 6});
  world.store.reset();
  make_format_3(world.file());
  {
    const auto reader = *open_world(world.place.path(), StoreAccess::read_only);
    CHECK(reader->tile_keys(kTileRules)->empty());
    CHECK_FALSE(reader->load_tile({1, {0, 0, 0}}, kTileRules)->has_value());
    CHECK(reader->check().has_value());
  }
  CHECK(raw_sql(world.file(), "PRAGMA user_version") == "3");  // a reader converts nothing
  world.store = *open_world(world.place.path(), StoreAccess::read_write);
  CHECK(raw_sql(world.file(), "PRAGMA user_version") == "5");
  world.save_tile({1, {0, 0, 0}}, {1, 6});
  CHECK(world.store->tile_keys(kTileRules)->size() == 1);
  CHECK(world.store->check().has_value());
}
