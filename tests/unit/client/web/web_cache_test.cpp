// WebCache with a page made of maps in place of IndexedDB.
#include "client/web/web_cache.hpp"

#include <catch2/catch.hpp>

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "client/web/page.hpp"
#include "tests/unit/client/cache/cache_samples.hpp"

namespace runstone::test {
namespace {

/// The page's part of the cache, as in page/chunks.js. run() carries out the calls of WebCache.
struct FakePage {
  struct Row {
    Epoch epoch = 0;
    double seq = 0;
    Bytes record;
  };
  std::map<std::string, std::string> worlds;  // by the hex of the id, as page_cache_enter() gave it
  std::map<std::string, std::map<ChunkKey, Row>> rows;
  std::deque<std::function<void(WebCache&)>> calls;
  std::size_t enters = 0;

  void run(WebCache& cache) {
    while (!calls.empty()) {
      const auto call = std::move(calls.front());
      calls.pop_front();
      call(cache);
    }
  }
  /// Returns the cache of the next visit.
  WebCache reload() {
    calls.clear();
    std::string lines;
    for (const auto& [world, text] : worlds) lines += world + ' ' + text + '\n';
    return WebCache(read_cached_worlds(lines));
  }
};

FakePage* page = nullptr;  // of the test that runs

struct CacheFixture {
  CacheFixture() { page = &store; }
  ~CacheFixture() { page = nullptr; }

  void keep(const CachedWorld& world, const std::vector<KeyedChunk>& chunks) {
    cache.keep(world, chunks);
    cache.flush();
    store.run(cache);
  }
  /// Returns what one lookup finds.
  std::vector<KeyedChunk> find(CacheLookup lookup) {
    cache.look_up(std::move(lookup));
    store.run(cache);
    auto results = cache.drain_results();
    REQUIRE(results.size() == 1);
    return std::move(results[0]);
  }

  FakePage store;
  WebCache cache{{}};
};

}  // namespace
}  // namespace runstone::test

extern "C" {

using runstone::ByteReader;
using runstone::ByteView;
using runstone::ChunkKey;
using runstone::WebCache;
using runstone::test::page;

void page_cache_enter(const char* world, const char* text) {
  ++page->enters;
  page->calls.emplace_back([world = std::string(world), text = std::string(text)](WebCache&) {
    page->worlds[world] = text;
  });
}

void page_cache_drop_rows(const char* world, int all, int edited, int lost, int tiles,
                          double common, std::uint32_t epoch) {
  page->calls.emplace_back([=, world = std::string(world)](WebCache& cache) {
    cache.dropped(std::erase_if(page->rows[world], [&](const auto& entry) {
      const auto& [key, row] = entry;
      return all != 0 || (edited != 0 && row.seq > 0) ||
             (lost != 0 && row.seq > common && row.epoch < epoch) || (tiles != 0 && key.lod != 0);
    }));
  });
}

void page_cache_drop_row(const char* world, int level, int x, int y, int z) {
  page->calls.emplace_back([=, world = std::string(world)](WebCache&) {
    page->rows[world].erase(ChunkKey{static_cast<std::uint8_t>(level), {x, y, z}});
  });
}

void page_cache_find(const char* world, const std::int32_t* keys, int count) {
  std::vector<ChunkKey> wanted;
  for (int i = 0; i < count; ++i, keys += 4)
    wanted.push_back({static_cast<std::uint8_t>(keys[0]), {keys[1], keys[2], keys[3]}});
  page->calls.emplace_back([world = std::string(world), wanted](WebCache& cache) {
    bool has_room = true;
    for (std::size_t i = 0; i < wanted.size() && has_room; ++i) {
      const auto row = page->rows[world].find(wanted[i]);
      if (row != page->rows[world].end()) has_room = cache.found(i, row->second.record);
    }
    cache.looked_up();
  });
}

void page_cache_keep(const char* world, const std::uint8_t* rows, int bytes) {
  page->calls.emplace_back(
      [world = std::string(world), batch = runstone::Bytes(rows, rows + bytes)](WebCache& cache) {
        std::size_t count = 0;
        for (ByteReader in{ByteView(batch)}; in.left() != 0; ++count) {
          const std::uint32_t size = in.u32();
          ChunkKey key;
          key.lod = static_cast<std::uint8_t>(in.u32());
          for (std::int32_t* c : {&key.at.x, &key.at.y, &key.at.z})
            *c = static_cast<std::int32_t>(in.u32());
          auto& row = page->rows[world][key];
          row.epoch = in.u32();
          row.seq = in.f64();
          const ByteView record = in.bytes(size);
          row.record.assign(record.begin(), record.end());
          REQUIRE(in.ok());
        }
        cache.kept(count, 0);
      });
}

}  // extern "C"

namespace runstone::test {

TEST_CASE_METHOD(CacheFixture, "a browser finds chunks as they were kept, also at the next visit",
                 "[web]") {
  const CachedWorld world = world_at(3, 90, 100);
  keep(world, chunks_at(0, 100, {3, 50}));
  keep(world, chunks_at(10, 10, {3, 60}));  // newer versions of some
  CHECK(cache.counters().kept == 110);
  CHECK(store.enters == 1);  // the description of the world is written when it changes
  cache = store.reload();
  const auto found = find({world, keys_of(0, 120)});
  REQUIRE(found.size() == 100);
  require_true(found);
  CHECK(found[9].second->version == Version{3, 50});
  CHECK(found[10].second->version == Version{3, 60});
  CHECK(cache.counters().hits == 100);
  CHECK(cache.counters().misses == 20);
  CHECK(find({world_at(3, 90, 100, 2), keys_of(0, 10)}).empty());  // another world
}

TEST_CASE_METHOD(CacheFixture, "a browser finds only common history after a restart of the server",
                 "[web]") {
  keep(world_at(1, 100, 110), chunks_at(0, 1, {}));
  keep(world_at(1, 100, 110), chunks_at(1, 1, {1, 100}));
  keep(world_at(1, 100, 110), chunks_at(2, 1, {1, 105}));  // not known to be durable
  if (GENERATE(false, true)) cache = store.reload();
  SECTION("a crash: the lost branch is dropped, even if the log is longer again") {
    CHECK(find({world_at(2, 500, 500), keys_of(0, 3)}).size() == 2);
    CHECK(cache.counters().not_common == 1);
    // It is not found later either, when the durable sequence is beyond it.
    CHECK(find({world_at(3, 900, 900), keys_of(0, 3)}).size() == 2);
    CHECK(cache.counters().not_common == 1);
  }
  SECTION("a crash that lost edits reported as durable") {
    CHECK(find({world_at(2, 99, 99), keys_of(0, 3)}).size() == 1);
    CHECK(cache.counters().not_common == 2);
  }
  SECTION("the same epoch: all history is common") {
    CHECK(find({world_at(1, 104, 130), keys_of(0, 3)}).size() == 3);
    CHECK(cache.counters().not_common == 0);
  }
  SECTION("a restored backup: no edited chunk is common") {
    CHECK(find({world_at(1, 80, 80), keys_of(0, 3)}).size() == 1);
    CHECK(cache.counters().not_common == 2);
  }
  SECTION("a restored backup whose log has grown past all that was seen") {
    CHECK(find({world_at(1 + kEpochsPerBranch, 900, 900), keys_of(0, 3)}).size() == 1);
  }
  SECTION("a world made anew with other chunks") {
    CachedWorld other = world_at(1, 104, 130);
    other.chunk_edge = 32;
    CHECK(find({other, keys_of(0, 3)}).empty());
    CHECK(cache.counters().corrupt == 0);  // they were dropped, not read
  }
}

TEST_CASE_METHOD(CacheFixture, "rows of a lost branch that wait to be written are discarded",
                 "[web]") {
  cache.keep(world_at(1, 100, 110), chunks_at(0, 1, {1, 105}));
  CHECK(find({world_at(2, 100, 100), keys_of(0, 1)}).empty());
  cache.flush();
  store.run(cache);
  CHECK(find({world_at(2, 100, 100), keys_of(0, 1)}).empty());
}

TEST_CASE_METHOD(CacheFixture, "a browser drops tiles of other rules and keeps chunks", "[web]") {
  CachedWorld world = world_at(3, 90, 100);
  world.tile_rules = 1;
  std::vector<KeyedChunk> kept = chunks_at(0, 2, {3, 50});
  kept[1].first.lod = 4;
  const std::vector<ChunkKey> keys = {kept[0].first, kept[1].first};
  keep(world, kept);
  world.tile_rules = 0;  // a connection without tiles
  CHECK(find({world, keys}).size() == 2);
  if (GENERATE(false, true)) cache = store.reload();
  world.tile_rules = 2;
  const auto found = find({world, keys});
  REQUIRE(found.size() == 1);
  CHECK(found[0].first.lod == 0);
  CHECK(cache.counters().not_common == 1);
}

TEST_CASE_METHOD(CacheFixture, "a browser drops rows that fail a check", "[web]") {
  const CachedWorld world = world_at(3, 90, 100);
  keep(world, chunks_at(0, 10, {3, 50}));
  auto& rows = store.rows.begin()->second;
  rows.at(key_at(2)).record.back() ^= 1;
  rows.at(key_at(5)).record.clear();
  rows.at(key_at(7)).record = rows.at(key_at(8)).record;  // of another chunk
  const auto found = find({world, keys_of(0, 10)});
  CHECK(found.size() == 7);
  require_true(found);
  CHECK(cache.counters().corrupt == 3);
  CHECK(rows.size() == 7);
}

TEST_CASE_METHOD(CacheFixture, "a lookup in a browser ends when the chunks found take its memory",
                 "[web]") {
  const CachedWorld world = world_at(3, 90, 100);
  keep(world, chunks_at(0, 100, {3, 50}));
  const auto some = find({world, keys_of(0, 100), 10 * sizeof(Chunk)});
  CHECK(!some.empty());
  CHECK(some.size() <= 10);
  require_true(some);
  CHECK(find({world, keys_of(0, 100), 0}).empty());
}

TEST_CASE_METHOD(CacheFixture, "rows that wait to be written are bounded", "[web]") {
  const CachedWorld world = world_at(3, 90, 100);
  for (std::size_t batch = 0; batch < WebCache::kBatchesMax; ++batch) {
    REQUIRE(cache.room() == WebCache::kBatchChunksMax);
    cache.keep(world, chunks_at(0, 10, {3, 50}));
    CHECK(cache.room() == WebCache::kBatchChunksMax - 10);
    cache.keep(world, chunks_at(10, static_cast<std::int32_t>(cache.room()), {3, 50}));
  }
  CHECK(cache.room() == 0);
  store.run(cache);
  CHECK(cache.room() == WebCache::kBatchChunksMax);
}

TEST_CASE_METHOD(CacheFixture, "chunks of two worlds are not written in one batch", "[web]") {
  cache.keep(world_at(3, 90, 100, 1), chunks_at(0, 2, {3, 50}));
  cache.keep(world_at(3, 90, 100, 2), chunks_at(0, 3, {3, 50}));
  cache.flush();
  store.run(cache);
  REQUIRE(store.rows.size() == 2);
  CHECK(store.rows.begin()->second.size() == 2);
  CHECK(store.rows.rbegin()->second.size() == 3);
}

TEST_CASE_METHOD(CacheFixture, "sequences that JavaScript cannot count exactly are not kept",
                 "[web]") {
  const CachedWorld world = world_at(3, 90, 100);
  constexpr Sequence kExact = Sequence{1} << 53;
  keep(world, chunks_at(0, 1, {3, kExact}));
  keep(world, chunks_at(1, 1, {3, kExact + 1}));
  CHECK(find({world, keys_of(0, 2)}).size() == 1);
}

TEST_CASE_METHOD(CacheFixture, "a cache that has failed answers every lookup", "[web]") {
  const CachedWorld world = world_at(3, 90, 100);
  keep(world, chunks_at(0, 3, {3, 50}));
  cache.look_up({world, keys_of(0, 3)});
  cache.fail();
  cache.look_up({world, keys_of(0, 3)});
  store.run(cache);  // the page is late
  const auto results = cache.drain_results();
  REQUIRE(results.size() == 2);
  CHECK((results[0].empty() && results[1].empty()));
  CHECK(cache.room() == 0);
}

TEST_CASE("lines of other forms are no known worlds", "[web]") {
  const std::string id(32, 'a');
  const auto worlds = read_cached_worlds(id + " 16 3 90 100 1\nzz 16 3 90 100 1\n" + id +
                                         " 16 3\n\n" + id.substr(2) + " 16 3 90 100 1");
  REQUIRE(worlds.size() == 1);
  CHECK(worlds[0].chunk_edge == 16);
  CHECK(worlds[0].mark == ServerMark{3, 90, 100});
  CHECK(worlds[0].tile_rules == 1);
}

}  // namespace runstone::test
