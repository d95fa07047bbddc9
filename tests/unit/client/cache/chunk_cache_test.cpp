#include "client/cache/chunk_cache.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "common/core/hash.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/unit/client/cache/cache_samples.hpp"

namespace runstone::test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

std::unique_ptr<ChunkCache> opened(const std::string& folder, std::uint64_t bytes_max = 64 * kMiB) {
  auto cache = ChunkCache::open(folder, bytes_max);
  if (!cache) FAIL(cache.error());
  return *std::move(cache);
}

}  // namespace

TEST_CASE("chunks are found as they were stored, also in another run", "[cache]") {
  const TempFolder folder;
  const CachedWorld world = world_at(3, 90, 100);
  {
    const auto cache = opened(folder.path());
    cache->keep(world, chunks_at(0, 100, {3, 50}));
    cache->keep(world, chunks_at(10, 10, {3, 60}));  // newer versions of some
    CHECK(cache->counters().kept == 110);
  }
  const auto cache = opened(folder.path());
  const auto found = cache->find({world, keys_of(0, 120)});
  REQUIRE(found.size() == 100);
  require_true(found);
  CHECK(found[9].second->version == Version{3, 50});
  CHECK(found[10].second->version == Version{3, 60});
  CHECK(cache->counters().hits == 100);
  CHECK(cache->counters().misses == 20);
  CHECK(cache->find({world_at(3, 90, 100, 2), keys_of(0, 10)}).empty());  // another world
  CHECK(cache->take_warning().empty());
}

TEST_CASE("a lookup ends when the chunks found take its memory", "[cache]") {
  const TempFolder folder;
  const CachedWorld world = world_at(3, 90, 100);
  const auto cache = opened(folder.path());
  cache->keep(world, chunks_at(0, 100, {3, 50}));
  const auto some = cache->find({world, keys_of(0, 100), 10 * sizeof(Chunk)});
  CHECK(!some.empty());
  CHECK(some.size() <= 10);
  require_true(some);
  CHECK(cache->find({world, keys_of(0, 100), 0}).empty());
}

TEST_CASE("after a restart of the server only common history is found", "[cache]") {
  const TempFolder folder;
  const auto cache = opened(folder.path());
  cache->keep(world_at(1, 100, 110), chunks_at(0, 1, {}));
  cache->keep(world_at(1, 100, 110), chunks_at(1, 1, {1, 100}));
  cache->keep(world_at(1, 100, 110), chunks_at(2, 1, {1, 105}));  // not known to be durable
  SECTION("a crash: chunks not known to be durable are dropped, even if the log is longer again") {
    CHECK(cache->find({world_at(2, 500, 500), keys_of(0, 3)}).size() == 2);
    CHECK(cache->counters().not_common == 1);
    // It is not found later either, when the durable sequence is beyond it.
    CHECK(cache->find({world_at(3, 900, 900), keys_of(0, 3)}).size() == 2);
  }
  SECTION("a crash that lost edits reported as durable") {
    CHECK(cache->find({world_at(2, 99, 99), keys_of(0, 3)}).size() == 1);
  }
  SECTION("the same epoch: all history is common") {
    CHECK(cache->find({world_at(1, 104, 130), keys_of(0, 3)}).size() == 3);
  }
  SECTION("a restored backup: no edited chunk is common") {
    CHECK(cache->find({world_at(1, 80, 80), keys_of(0, 3)}).size() == 1);
  }
  SECTION("a restored backup whose log has grown past all that was seen") {
    CHECK(cache->find({world_at(1 + kEpochsPerBranch, 900, 900), keys_of(0, 3)}).size() == 1);
  }
  SECTION("a world made anew with other chunks") {
    CachedWorld other = world_at(1, 104, 130);
    other.chunk_edge = 32;
    CHECK(cache->find({other, keys_of(0, 3)}).empty());
  }
}

TEST_CASE("the cache keeps its size bound and evicts the chunks unused for longest", "[cache]") {
  const TempFolder folder;
  const CachedWorld world = world_at(1, 1000, 1000);
  const auto cache = opened(folder.path(), kMiB / 2);
  for (int batch = 0; batch < 20; ++batch) {
    cache->keep(world, chunks_at(batch * 50, 50, {1, 7}));
    CHECK(cache->find({world, keys_of(0, 10)}).size() == 10);  // used in each round
    CHECK(cache->bytes() <= kMiB / 2);
  }
  CHECK(cache->counters().evicted > 100);
  CHECK(cache->find({world, keys_of(950, 50)}).size() == 50);  // the newest are here
  CHECK(cache->find({world, keys_of(50, 50)}).empty());        // the oldest are not
  CHECK(std::filesystem::file_size(folder / "cache.sqlite") <= kMiB);
}

TEST_CASE("a file with flipped bits never gives a wrong chunk", "[cache]") {
  const TempFolder folder;
  const CachedWorld world = world_at(1, 1000, 1000);
  opened(folder.path())->keep(world, chunks_at(0, 200, {1, 7}));
  std::ifstream in(folder / "cache.sqlite", std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  REQUIRE(whole.size() > 50'000);
  SplitMix64 rng{Catch::rngSeed()};
  std::size_t lost = 0, set_aside = 0, corrupt = 0;
  for (int round = 0; round < 60; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    std::string damaged = whole;
    for (int flips = 1 + round % 20; flips > 0; --flips) {
      damaged[rng.below(static_cast<std::uint32_t>(damaged.size()))] ^=
          static_cast<char>(1 << rng.below(8));
    }
    const TempFolder other;
    std::ofstream(other / "cache.sqlite", std::ios::binary) << damaged;
    const auto cache = opened(other.path());
    const auto found = cache->find({world, keys_of(0, 200)});
    require_true(found);
    lost += 200 - found.size();
    corrupt += cache->counters().corrupt;
    set_aside += cache->counters().databases_set_aside;
    // The cache goes on working.
    cache->keep(world, chunks_at(500, 5, {1, 9}));
    require_true(cache->find({world, keys_of(0, 200)}));
  }
  CHECK(lost > 0);
  CHECK(corrupt > 0);
  CHECK(set_aside > 0);
}

TEST_CASE("a damaged database is set aside with a warning, and a new one is begun", "[cache]") {
  const TempFolder folder;
  std::ofstream(folder / "cache.sqlite") << std::string(10'000, 'x');
  const auto cache = opened(folder.path());
  CHECK(cache->take_warning().find("set aside") != std::string::npos);
  CHECK(cache->counters().databases_set_aside == 1);
  CHECK(std::filesystem::exists(folder / "cache.sqlite.damaged"));
  const CachedWorld world = world_at(1, 1, 1);
  cache->keep(world, chunks_at(0, 3, {1, 1}));
  CHECK(cache->find({world, keys_of(0, 3)}).size() == 3);
}

TEST_CASE("one process at a time uses the cache", "[cache]") {
  const TempFolder folder;
  auto first = opened(folder.path());
  const auto second = ChunkCache::open(folder.path(), kMiB);
  REQUIRE_FALSE(second.has_value());
  CHECK(second.error().find("in use by another client") != std::string::npos);
  first.reset();
  CHECK(ChunkCache::open(folder.path(), kMiB).has_value());
  CHECK_FALSE(ChunkCache::open("/proc/no/such/folder", kMiB).has_value());
}

TEST_CASE("a client that is killed while it writes leaves no wrong chunk", "[cache]") {
  const TempFolder folder;
  const CachedWorld world = world_at(1, 1'000'000, 1'000'000);
  SplitMix64 rng{Catch::rngSeed()};
  std::size_t found_ever = 0;
  for (int round = 0; round < 8; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      auto cache = ChunkCache::open(folder.path(), 2 * kMiB);
      if (!cache) ::_exit(1);
      for (Sequence seq = 1;; ++seq) {
        (*cache)->keep(world, chunks_at(static_cast<std::int32_t>(seq % 20) * 20, 20, {1, seq}));
      }
    }
    // The later the kill, the more was written, also on a busy machine.
    ::usleep((20'000 + rng.below(80'000)) << (found_ever == 0 ? round : 0));
    REQUIRE(::kill(child, SIGKILL) == 0);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    const auto cache = opened(folder.path(), 2 * kMiB);
    const auto found = cache->find({world, keys_of(0, 400)});
    require_true(found);
    CHECK(cache->counters().corrupt == 0);
    CHECK(cache->counters().databases_set_aside == 0);
    found_ever += found.size();
  }
  CHECK(found_ever > 0);
}

TEST_CASE("tiles and chunks of the same coordinates are kept apart", "[cache]") {
  const TempFolder folder;
  const CachedWorld world = world_at(3, 90, 100);
  std::vector<KeyedChunk> kept = chunks_at(0, 3, {3, 50});
  for (std::uint8_t level = 1; level <= 2; ++level) {
    for (const auto& [key, chunk] : chunks_at(10 * level, 3, {3, 60}))
      kept.emplace_back(ChunkKey{level, kept[kept.size() % 3].first.at}, chunk);
  }
  std::vector<ChunkKey> keys;
  for (const auto& [key, chunk] : kept) keys.push_back(key);
  {
    const auto cache = opened(folder.path());
    cache->keep(world, kept);
  }
  const auto cache = opened(folder.path());
  CHECK(cache->find({world, keys}).size() == kept.size());
  for (const KeyedChunk& one : kept) {
    const auto found = cache->find({world, {one.first}});
    REQUIRE(found.size() == 1);
    CHECK(found[0].first == one.first);
    CHECK(*found[0].second == *one.second);
  }
  CHECK(cache->find({world, {{3, kept[0].first.at}}}).empty());
  CHECK(cache->counters().misses == 1);
}

TEST_CASE("tiles of other rules are dropped, chunks stay", "[cache]") {
  const TempFolder folder;
  CachedWorld world = world_at(3, 90, 100);
  world.tile_rules = 1;
  const auto cache = opened(folder.path());
  std::vector<KeyedChunk> kept = chunks_at(0, 2, {3, 50});
  kept[1].first.lod = 4;
  const std::vector<ChunkKey> keys = {kept[0].first, kept[1].first};
  cache->keep(world, kept);
  world.tile_rules = 0;  // a connection without tiles
  CHECK(cache->find({world, keys}).size() == 2);
  world.tile_rules = 2;
  const auto found = cache->find({world, keys});
  REQUIRE(found.size() == 1);
  CHECK(found[0].first.lod == 0);
  CHECK(cache->counters().not_common == 1);
}

TEST_CASE("tiles that were unused for longest are evicted like chunks", "[cache]") {
  const TempFolder folder;
  const CachedWorld world = world_at(3, 90, 100);
  const auto cache = opened(folder.path(), kMiB / 4);
  std::vector<KeyedChunk> tiles = chunks_at(0, 60, {3, 50});
  for (KeyedChunk& tile : tiles) tile.first.lod = 1;
  cache->keep(world, tiles);
  std::int32_t next = 100;
  while (cache->counters().evicted == 0) {
    cache->keep(world, chunks_at(next, 10, {3, 50}));
    next += 10;
    REQUIRE(next < 4'000);
  }
  std::vector<ChunkKey> keys;
  for (const KeyedChunk& tile : tiles) keys.push_back(tile.first);
  CHECK(cache->find({world, keys}).size() < tiles.size());
  CHECK(cache->find({world, keys_of(100, next - 100)}).size() ==
        static_cast<std::size_t>(next - 100));
  CHECK(cache->bytes() <= kMiB / 4);
}

}  // namespace runstone::test
