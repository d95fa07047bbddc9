#include "server/tiles/tile_source.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>

#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/tiles/tile_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

std::vector<ChunkKey> keys_of(const std::vector<MadeTile>& made) {
  std::vector<ChunkKey> keys;
  for (const MadeTile& tile : made) keys.push_back(tile.key);
  return keys;
}

}  // namespace

TEST_CASE("ground without edits is approximated from level 3 on, and made of chunks below",
          "[tiles]") {
  TileWorld world({"terrain", 1, 7, ""});
  const auto coarse = world.make({kCoarseLevelMin, {0, 0, 0}});
  REQUIRE(coarse.size() == 1);
  CHECK(coarse[0].is_approximate);
  CHECK_FALSE(coarse[0].is_worth_storing());
  CHECK(coarse[0].tile->version == Version{});
  CHECK(coarse[0].tile->digest == digest_of(coarse[0].tile->voxels));
  CHECK_FALSE(coarse[0].tile->voxels.is_uniform());

  const auto exact = world.make({2, {0, 0, 0}});
  CHECK(exact.size() == 9);
  CHECK_FALSE(exact.back().is_approximate);
  CHECK(exact.back().is_worth_storing());
}

TEST_CASE("an edit makes an approximated tile exact, and the tiles above it stay approximate",
          "[tiles]") {
  TileWorld world({"terrain", 1, 7, ""});
  REQUIRE(world.make({3, {0, 0, 0}}).back().is_approximate);
  world.edit({{1, 2, 3}});
  const auto exact = world.make({3, {0, 0, 0}});
  CHECK_FALSE(exact.back().is_approximate);
  CHECK(exact.back().tile->version == Version{1, 1});
  CHECK(exact.size() == 1 + 8 + 64);
  const auto above = world.make({4, {0, 0, 0}});
  CHECK(above.back().is_approximate);
  CHECK(above.back().tile->version == Version{1, 1});
  CHECK(keys_of(above) == std::vector{ChunkKey{4, {0, 0, 0}}});  // the others were made before
}

TEST_CASE("chunks that an earlier run stored are ground", "[tiles]") {
  TileWorld world({"terrain", 1, 7, ""});
  world.edit({{1, 2, 3}});
  world.save_all();
  world.start();
  CHECK_FALSE(world.make({3, {0, 0, 0}}).back().is_approximate);
  CHECK(world.make({3, {1, 0, 0}}).back().is_approximate);
}

TEST_CASE("a tile without any voxel is the uniform empty tile", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  const auto made = world.make({2, {0, 0, 0}});
  CHECK(made.back().tile->voxels == uniform_chunk(Extent::cube(kSampleEdge), kEmpty, kTileOrder));
  CHECK(made.back().tile->digest == Digest{});
}

TEST_CASE("a tile of the folder is used until an edit below it is newer", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}, {5, 0, 0}});
  world.save_all();
  const auto first = world.make({1, {0, 0, 0}});
  REQUIRE(first.back().is_worth_storing());
  world.save_tiles(first);
  world.start();
  const auto stored = world.make({1, {0, 0, 0}});
  CHECK(stored.back().is_known);
  CHECK_FALSE(stored.back().is_worth_storing());
  CHECK(*stored.back().tile == *first.back().tile);

  world.start();
  world.edit({{1, 1, 1}});
  const auto made = world.make({1, {0, 0, 0}});
  CHECK_FALSE(made.back().is_known);
  CHECK(made.back().tile->version == Version{world.epoch, 2});
  CHECK(made.back().through == 2);
}

TEST_CASE("a tile that was made lately is used until an edit below it is newer", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  const auto first = world.make({1, {0, 0, 0}});
  CHECK_FALSE(first.back().is_known);
  world.edit({{7, 7, 7}});  // below another tile
  const auto again = world.make({1, {0, 0, 0}});
  CHECK(again.back().is_known);
  CHECK(again.back().tile == first.back().tile);
  CHECK(again.back().through == 2);
  world.edit({{0, 0, 1}});
  CHECK(world.make({1, {0, 0, 0}}).back().tile->version == Version{1, 3});
}

TEST_CASE("tiles of other rules are neither used nor current", "[tiles][shapes]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  world.save_all();
  const ChunkKey key{2, {0, 0, 0}};
  const auto first = world.make(key);
  world.save_tiles(first);
  const Version version = first.back().tile->version;
  const std::uint64_t digest = first.back().for_clients()->digest.lane[0];
  CHECK(world.source->is_current(key, version, digest, kTileRules));

  TileVisibility other(*world.visibility);
  other.rules = tile_rules_of(7);
  const auto made = *world.source->make(world.request(key), other);
  CHECK_FALSE(made.back().is_known);
  CHECK(made.back().rules == other.rules);
  CHECK(*made.back().tile == *first.back().tile);  // the materials are cubes still
  CHECK(world.source->make(world.request(key), other)->back().is_known);
  // The tile of the other rules is in memory: its digest does not count.
  CHECK(world.source->is_current(key, version, digest + 1, kTileRules));
  CHECK_FALSE(world.source->is_current(key, version, digest + 1, other.rules));
  // The store has the number of the rules of its own materials.
  REQUIRE(world.store->save_tiles({}, other.rules).has_value());
  CHECK(world.store->load_tile(key, kTileRules).value().has_value());
  CHECK_FALSE(world.store->load_tile(key, other.rules).value().has_value());
  CHECK(world.store->tile_keys(other.rules)->empty());
}

TEST_CASE("a source that reads no stored tiles makes all of chunks", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  world.save_all();
  world.save_tiles(world.make({2, {0, 0, 0}}));
  TileLedger ledger;
  TileSource::Options options;
  options.reads_stored_tiles = false;
  TileSource source(*world.chunk_source, *world.generator, kSampleEdge, ledger, {}, options);
  const auto made = source.make({{2, {0, 0, 0}}, world.head, {}}, *world.visibility);
  REQUIRE(made.has_value());
  CHECK(made->size() == 9);
  CHECK(*made->back().tile == **world.store->load_tile({2, {0, 0, 0}}, kTileRules));
}

TEST_CASE("a damaged row of a tile is reported and made anew", "[tiles][damage]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  world.save_all();
  const auto first = world.make({1, {0, 0, 0}});
  world.save_tiles(first);
  world.start();
  REQUIRE(raw_sql(world.file(), "UPDATE tile SET digest1 = digest1 + 1; SELECT changes()") == "1");
  const auto again = world.make({1, {0, 0, 0}});
  CHECK(world.warnings ==
        std::vector{world.file() +
                    ": tile chunk=0,0,0 lod=1: checksum is wrong; the tile is made again"});
  CHECK(*again.back().tile == *first.back().tile);
  REQUIRE(again.back().is_worth_storing());
  world.save_tiles(again);
  world.start();
  CHECK(world.make({1, {0, 0, 0}}).back().is_known);
  CHECK(world.warnings.size() == 1);
}

TEST_CASE("a damaged chunk is reported once, and tiles show nothing there", "[tiles][damage]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}, {1, 0, 0}});
  world.save_all();
  REQUIRE(raw_sql(world.file(), "UPDATE snapshot SET seq = 9 WHERE x = 0; SELECT changes()") ==
          "1");
  REQUIRE(raw_sql(world.file(), "SELECT count(*) FROM snapshot") == "2");
  world.ledger->stored(std::vector<std::pair<ChunkKey, Version>>{{{0, {0, 0, 0}}, {1, 1}}});
  const auto made = world.source->make(world.request({1, {0, 0, 0}}), *world.visibility);
  // The fold of the table is wrong as well, so the keys of the chunks cannot be read.
  CHECK_FALSE(made.has_value());

  REQUIRE(raw_sql(world.file(),
                  "UPDATE snapshot SET seq = 1, checksum = 0 WHERE x = 0; "
                  "SELECT changes()") == "1");
  const auto damaged = world.make({1, {0, 0, 0}});
  CHECK(damaged.back().is_approximate);
  CHECK_FALSE(damaged.back().is_worth_storing());
  TileScratch scratch;
  const ChunkPtr sound = world.chunk({1, 0, 0});
  CHECK(damaged.back().tile->voxels ==
        build_tile({nullptr, &sound->voxels}, kSampleEdge, kTileOrder, *world.visibility, scratch));
  CHECK(world.make({2, {0, 0, 0}}).back().is_approximate);
  CHECK(world.warnings == std::vector{world.file() + ": snapshot chunk=0,0,0: checksum is wrong"});
}

TEST_CASE("a chunk that cannot be shown is left out of its tile", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  TileRequest request = world.request({1, {0, 0, 0}});
  REQUIRE(request.fresh.size() == 1);
  request.fresh[0].second = nullptr;
  const auto made = world.source->make(request, *world.visibility);
  REQUIRE(made.has_value());
  CHECK(made->back().is_approximate);
  CHECK(made->back().tile->voxels == uniform_chunk(Extent::cube(kSampleEdge), kEmpty, kTileOrder));
}

TEST_CASE("a tile with an edit behind the head of its request is not stored", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  world.save_all();
  TileRequest request = world.request({1, {0, 0, 0}});
  world.edit({{0, 0, 0}, {1, 0, 0}});
  world.save({{0, 0, 0}});  // the other chunk is not on disk yet
  const auto made = world.source->make(request, *world.visibility);
  REQUIRE(made.has_value());
  CHECK(made->back().tile->version == Version{1, 2});
  CHECK(made->back().through == 1);
  CHECK_FALSE(made->back().is_worth_storing());
  CHECK(world.make({1, {0, 0, 0}}).back().tile->version == Version{1, 2});
}

TEST_CASE("several threads make the same tiles while edits are reported", "[tiles]") {
  TileWorld world({"terrain", 1, 7, ""});
  world.edit({{0, 1, 0}, {3, 2, 1}});
  world.save_all();
  const std::vector<ChunkKey> keys = {{2, {0, 0, 0}}, {1, {0, 0, 0}}, {1, {1, 1, 0}}};
  std::vector<Digest> expected;
  for (const ChunkKey& key : keys) expected.push_back(world.make(key).back().tile->digest);
  world.start();
  std::array<bool, 3> is_equal{};
  std::vector<std::thread> threads;
  for (bool& equal : is_equal) {
    threads.emplace_back([&] {
      equal = true;
      for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto made = world.source->make({keys[i], world.head, {}}, *world.visibility);
        equal = equal && made && made->back().tile->digest == expected[i];
      }
    });
  }
  for (std::int32_t x = 100; x < 600; ++x)
    world.ledger->edited(std::vector{ChunkCoord{x, 0, 0}}, static_cast<Sequence>(x));
  for (std::thread& thread : threads) thread.join();
  CHECK(is_equal == std::array{true, true, true});
}

TEST_CASE("a folder that cannot be read fails a tile, and the next call tries again", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  world.save_all();
  REQUIRE(raw_sql(world.file(), "UPDATE meta SET checksum = checksum + 1 WHERE key = 'base_fold'")
              .empty());
  CHECK_FALSE(world.source->make(world.request({1, {0, 0, 0}}), *world.visibility).has_value());
  REQUIRE(raw_sql(world.file(), "UPDATE meta SET checksum = checksum - 1 WHERE key = 'base_fold'")
              .empty());
  CHECK(world.source->make(world.request({1, {0, 0, 0}}), *world.visibility).has_value());
}

namespace {

bool is_current(TileWorld& world, const ChunkKey& key, const Chunk& copy) {
  return world.source->is_current(key, copy.version, copy.digest.lane[0], kTileRules);
}

}  // namespace

TEST_CASE("a copy of a tile is known to be current until an edit below, without making it",
          "[tiles]") {
  TileWorld world({"terrain", 1, 3, ""});
  const ChunkKey near{1, {0, 0, 0}}, above{2, {0, 0, 0}}, far{1, {2, 0, 0}};
  world.edit({{0, 0, 0}});
  world.save_all();
  std::map<ChunkKey, Chunk> copies;
  for (const ChunkKey& key : {near, above, far})
    copies[key] = *world.make(key).back().for_clients();
  for (const auto& [key, copy] : copies) {
    CHECK(is_current(world, key, copy));
    Chunk other = copy;
    other.digest.lane[0] ^= 1;
    CHECK_FALSE(is_current(world, key, other));
    other = copy;
    other.version.seq += 1;
    CHECK_FALSE(is_current(world, key, other));
  }
  // A tile that was made for the one above only has no veil yet. Then the version decides.
  static_cast<void>(world.make({2, {3, 0, 0}}));
  Chunk child;
  child.digest.lane[0] = 1;
  CHECK(is_current(world, {1, {6, 0, 0}}, child));
  child.version.seq = 1;
  CHECK_FALSE(is_current(world, {1, {6, 0, 0}}, child));
  world.start();
  // The ground of a folder is not known before the first tile is made.
  for (const auto& [key, copy] : copies) CHECK_FALSE(is_current(world, key, copy));
  static_cast<void>(world.make({1, {50, 0, 50}}));
  for (const auto& [key, copy] : copies) CHECK(is_current(world, key, copy));
  world.edit({{1, 0, 0}});
  CHECK_FALSE(is_current(world, near, copies[near]));
  CHECK_FALSE(is_current(world, above, copies[above]));
  CHECK(is_current(world, far, copies[far]));
  CHECK(is_current(world, near, *world.make(near).back().for_clients()));
  world.start();  // the edit is in no snapshot
  static_cast<void>(world.make({1, {50, 0, 50}}));
  CHECK_FALSE(is_current(world, near, copies[near]));
  CHECK(is_current(world, far, copies[far]));
}

TEST_CASE("an incomplete tile has the digest 0, so that it is never claimed", "[tiles]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}, {1, 0, 0}});
  TileRequest request = world.request({1, {0, 0, 0}});
  request.head = 0;
  request.fresh.pop_back();
  const auto made = world.source->make(request, *world.visibility);
  REQUIRE(made.has_value());
  CHECK_FALSE(made->back().is_complete());
  CHECK(made->back().tile->digest == Digest{});
  CHECK_FALSE(is_current(world, {1, {0, 0, 0}}, *made->back().tile));
  const MadeTile whole = world.make({1, {0, 0, 0}}).back();
  CHECK(whole.is_complete());
  CHECK(whole.tile->digest == digest_of(whole.tile->voxels));

  world.save_all();
  REQUIRE(raw_sql(world.file(), "UPDATE snapshot SET checksum = 0 WHERE x = 0; SELECT changes()") ==
          "1");
  world.start();
  const MadeTile damaged = world.make({2, {0, 0, 0}}).back();
  CHECK(damaged.is_damaged);
  CHECK(damaged.tile->digest == Digest{});
}

TEST_CASE("a call that stops goes on where it was, and ends with the same tile", "[tiles]") {
  TileWorld world({"terrain", 1, 7, ""});
  for (std::int32_t i = 0; i < 12; ++i) world.edit({{i * 7 % 40, i % 3, i * 11 % 40}});
  world.save_all();
  world.start();
  const ChunkKey key{6, {0, 0, 0}};
  TileRequest request = world.request(key);
  CHECK(request.steps_max > 1'000'000);
  const auto at_once = world.source->make(request, *world.visibility);
  REQUIRE(at_once.has_value());
  world.start();
  request.steps_max = 200;
  std::vector<MadeTile> on_the_way;
  int calls = 0;
  for (;; ++calls) {
    REQUIRE(calls < 1'000);
    const auto made = world.source->make(request, *world.visibility);
    REQUIRE(made.has_value());
    on_the_way.insert(on_the_way.end(), made->begin(), made->end());
    if (!made->empty() && made->back().key == key) break;
  }
  CHECK(calls > 5);
  CHECK(*on_the_way.back().tile == *at_once->back().tile);
  std::vector<ChunkKey> keys = keys_of(on_the_way), expected = keys_of(*at_once);
  std::sort(keys.begin(), keys.end());
  std::sort(expected.begin(), expected.end());
  CHECK(keys == expected);  // nothing is made twice
}

TEST_CASE("a tile of the past is the tile that was made then", "[tiles][travel]") {
  TileWorld world({"terrain", 1, 7, ""}, 5);
  const std::vector<ChunkKey> keys = {{1, {0, 0, 0}}, {2, {0, 0, 0}}, {3, {0, 0, 0}},
                                      {1, {1, 0, 0}}, {2, {1, 0, 0}}, {1, {0, 1, 1}}};
  std::vector<std::map<ChunkCoord, ChunkPtr>> chunks;           // by the number of edits
  std::vector<std::map<ChunkKey, std::vector<MadeTile>>> made;  // likewise
  world.edit({{1, 1, 1}});                                      // from here on, level 3 is exact
  for (std::size_t moment = 0; moment < 6; ++moment) {
    if (moment == 3) world.save_all();
    chunks.push_back(world.chunks);
    auto& tiles = made.emplace_back();
    for (const ChunkKey& key : keys) tiles[key] = world.make(key);
    const auto draw = [&world] { return static_cast<std::int32_t>(world.random.below(4)); };
    world.edit({{draw(), draw(), draw()}, {draw(), 0, 0}});
  }
  std::size_t past_chunks = 0, past_tiles = 0, turns = 0;
  for (std::size_t moment = 0; moment < made.size(); ++moment) {
    const auto past_chunk = [&](const ChunkKey& key) -> StoreResult<Chunk> {
      ++past_chunks;
      const auto edited = chunks[moment].find(key.at);
      if (edited != chunks[moment].end()) return *edited->second;
      return generated_chunk(*world.generator, key, kSampleEdge);
    };
    for (const ChunkKey& key : keys) {
      INFO("moment " << moment << ", level " << int{key.lod} << " at " << key.at.x);
      TileRequest request = world.past_request(key, moment + 1);
      request.steps_max = 10;
      auto past = world.source->make(request, *world.visibility, past_chunk);
      for (; past && (past->empty() || past->back().key != key); ++turns) {
        past = world.source->make(request, *world.visibility, past_chunk);
        CHECK(request.past_made->size() <= 8 * key.lod);
      }
      REQUIRE(past.has_value());
      const MadeTile& tile = past->back();
      const MadeTile& then = made[moment][key].back();
      CHECK(tile.tile->voxels == then.tile->voxels);
      CHECK(tile.tile->version == then.tile->version);
      past_tiles += tile.is_past ? 1 : 0;
      if (!tile.is_past) continue;
      CHECK(tile.tile->digest == Digest{});  // no client keeps it
      CHECK_FALSE(tile.is_worth_storing());
    }
  }
  CHECK(past_chunks > 0);
  CHECK(past_tiles > 10);
  CHECK(turns > 0);
  // The present is not disturbed.
  for (const ChunkKey& key : keys) {
    TileSource fresh(*world.chunk_source, *world.generator, kSampleEdge, *world.ledger, {});
    const auto now = fresh.make(world.request(key), *world.visibility);
    REQUIRE(now.has_value());
    CHECK(*world.make(key).back().tile == *now->back().tile);
  }
}

TEST_CASE("a tile of the past has the edits that are neither in memory nor in a snapshot",
          "[tiles][travel]") {
  TileWorld world({"empty", 1, 0, ""}, 5);
  world.edit({{0, 0, 0}});
  world.save_all();
  world.edit({{0, 0, 0}});  // only the log has it
  const Chunk then = *world.chunk({0, 0, 0});
  const MadeTile made = world.make({1, {0, 0, 0}}).back();
  world.edit({{1, 0, 0}});
  TileRequest request = world.past_request({1, {0, 0, 0}}, 2);
  std::erase_if(request.fresh, [](const auto& one) { return one.first == ChunkCoord{0, 0, 0}; });
  request.head = 0;
  const auto past = world.source->make(request, *world.visibility,
                                       [&](const ChunkKey& key) -> StoreResult<Chunk> {
                                         if (key.at == ChunkCoord{0, 0, 0}) return then;
                                         return generated_chunk(*world.generator, key, kSampleEdge);
                                       });
  REQUIRE(past.has_value());
  CHECK(past->back().tile->voxels == made.tile->voxels);
}

TEST_CASE("a chunk of the past that cannot be read fails its tile, and a damaged one is left out",
          "[tiles][travel][damage]") {
  TileWorld world({"empty", 1, 0, ""});
  world.edit({{0, 0, 0}});
  world.edit({{0, 0, 0}, {1, 0, 0}});
  const auto make = [&](StoreError::Kind kind) {
    return world.source->make(
        world.past_request({1, {0, 0, 0}}, 1), *world.visibility, [kind](const ChunkKey& /*key*/) {
          return StoreResult<Chunk>(failure(StoreError{kind, "file", "table", "row"}));
        });
  };
  CHECK_FALSE(make(StoreError::Kind::io).has_value());
  const auto damaged = make(StoreError::Kind::corrupt);
  REQUIRE(damaged.has_value());
  CHECK(damaged->back().is_damaged);
  CHECK(is_empty(damaged->back().tile->voxels));
  CHECK(world.warnings.size() == 2);
}
