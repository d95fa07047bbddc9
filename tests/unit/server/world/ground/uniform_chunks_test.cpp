// Uniform chunks: many are sent in one message. Everything else is as for any snapshot.
#include <catch2/catch.hpp>
#include <set>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

constexpr View kView{1, {0, 0, 0}, 4, 3};  // 343 chunks

/// Answers all loads with air, except those of chunks at height 0.
void answer(WorldBench& bench) {
  while (!bench.environment.loads.empty()) {
    const ChunkKey key = bench.environment.loads.front();
    bench.environment.loads.pop_front();
    bench.server.chunk_loaded(key, key.at.y == 0 ? dotted_chunk(kEdge) : empty_chunk(kEdge),
                              bench.now());
  }
}

/// Session 1 joins with a view of three chunks of air.
void join_above(WorldBench& bench) {
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 3, 0}, 0, 1});
}

/// Answers the oldest load with air.
ChunkKey load_air(WorldBench& bench) {
  const ChunkKey key = bench.environment.loads.front();
  bench.environment.loads.pop_front();
  bench.server.chunk_loaded(key, empty_chunk(kEdge), bench.now());
  return key;
}

std::vector<UniformChunks> uniform(const WorldBench& bench, SessionId session) {
  return bench.environment.messages<UniformChunks>(session, kEdge);
}
std::set<ChunkKey> keys_of(const std::vector<UniformChunks>& messages) {
  std::set<ChunkKey> keys;
  for (const auto& message : messages) {
    for (const UniformChunk& chunk : message.chunks) CHECK(keys.insert(chunk.key).second);
  }
  return keys;
}

TEST_CASE("one message has many uniform chunks, at a few bytes each", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.send_view(1, kView);
  answer(bench);
  const std::size_t mixed = 49;
  CHECK(bench.environment.snapshots.size() == mixed);
  CHECK(keys_of(uniform(bench, 1)).size() == 343 - mixed);

  // A session that joins when all chunks are in memory gets them at once.
  bench.join(2, 2);
  const std::size_t before = bench.environment.sent.size();
  bench.send_view(2, kView);
  const auto messages = uniform(bench, 2);
  CHECK(keys_of(messages).size() == 343 - mixed);
  CHECK(messages.size() <= 2);
  std::size_t bytes = 0;
  for (std::size_t i = before; i < bench.environment.sent.size(); ++i)
    bytes += bench.environment.sent[i].message.bytes->size();
  CHECK(bytes < 4 * (343 - mixed));
}

TEST_CASE("subscribing to a uniform chunk and taking its version are one call", "[world]") {
  WorldBench bench;
  join_above(bench);
  REQUIRE(bench.environment.loads.size() == 3);
  const ChunkKey first = load_air(bench);
  CHECK(uniform(bench, 1).empty());  // they wait, because more chunks load
  const VoxelPos inside{1, first.at.y * kEdge + 1, 1};
  bench.edit(1, 1, SetVoxel{inside}, 2);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 1);  // the session is subscribed since the chunk is due
  load_air(bench);
  load_air(bench);
  const auto messages = uniform(bench, 1);
  REQUIRE(messages.size() == 1);
  REQUIRE(messages[0].chunks.size() == 3);
  for (const UniformChunk& chunk : messages[0].chunks) {
    CHECK(chunk.version == Version{});  // the version when it became due; the commit follows
    CHECK(chunk.material == kEmpty);
  }
}

TEST_CASE("uniform chunks that are due wait for one tick at most", "[world]") {
  WorldBench bench;
  join_above(bench);
  load_air(bench);
  bench.tick();
  REQUIRE(uniform(bench, 1).size() == 1);
  CHECK(uniform(bench, 1)[0].chunks.size() == 1);
}

TEST_CASE(
    "uniform chunks that are due are sent when a full queue has room, at their newest version",
    "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.environment.full.insert(1);
  bench.send_view(1, View{1, {0, 3, 0}, 0, 1});
  answer(bench);
  CHECK(uniform(bench, 1).empty());
  CHECK(bench.server.counters().queue_full > 0);
  // A commit that does not fit makes its chunk stale, so it is due again.
  bench.edit(1, 1, FillBox{{{0, 48, 0}, {16, 64, 16}}}, 2);
  bench.server.commit(bench.now());
  bench.environment.full.clear();
  bench.server.drained(1, bench.now());
  bench.tick();
  const auto messages = uniform(bench, 1);
  CHECK(keys_of(messages).size() == 3);
  for (const auto& message : messages) {
    for (const UniformChunk& chunk : message.chunks) {
      const bool is_filled = chunk.key == ChunkKey{0, {0, 3, 0}};
      CHECK(chunk.material == (is_filled ? 2 : kEmpty));
      CHECK(chunk.version == (is_filled ? Version{1, 1} : Version{}));
    }
  }
}

TEST_CASE("a uniform chunk that left the view before it was sent is not sent", "[world]") {
  WorldBench bench;
  join_above(bench);
  load_air(bench);
  bench.time_us += 100'000;
  bench.send_view(1, View{1, {90, 3, 0}, 0, 0});
  answer(bench);
  bench.tick();
  CHECK(keys_of(uniform(bench, 1)) == std::set<ChunkKey>{{0, {90, 3, 0}}});
}

}  // namespace
}  // namespace runstone
