#include "server/world/view_scheduler.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

std::set<ChunkKey> sent_to(const WorldBench& bench, SessionId session, std::size_t first = 0) {
  std::set<ChunkKey> keys;
  for (std::size_t i = first; i < bench.ports.snapshots.size(); ++i) {
    if (bench.ports.snapshots[i].session == session) keys.insert(bench.ports.snapshots[i].key);
  }
  return keys;
}

std::size_t cells_of(const View& view) {
  std::vector<ChunkCoord> cells;
  append_difference(view, std::nullopt, {}, cells);
  return cells.size();
}

TEST_CASE("a peer that looks elsewhere each millisecond costs neither loads nor an editor's turn",
          "[world]") {
  WorldConfig c = config();
  c.loads_in_flight_max = 4;
  WorldBench bench(c);
  bench.join(1, 1);
  bench.join(2, 2);
  bench.view(1, kSmall);
  bench.ports.loads.clear();
  const View last{{9'000, 0, 0}, 4, 4};
  std::size_t loads_answered = 0;
  std::optional<std::size_t> moved_at, arrived_at;
  ClientSequence seq = 0;
  for (int ms = 0; ms < 1'000; ++ms) {
    bench.time_us += 1'000;
    bench.server.received(2, ms == 999 ? last : View{{100 + 20 * ms, 0, 0}, 4, 4}, bench.now());
    if (ms == 500) {  // the editor walks on: five chunks that nobody has loaded
      bench.server.received(1, View{{-50, 0, 0}, 1, 0}, bench.now());
      moved_at = loads_answered;
    }
    if (ms % 10 == 0) {
      const std::size_t before = bench.commits(1).size();
      ++seq;
      bench.edit(1, seq, kAtOrigin, static_cast<Material>(1 + seq % 2));
      bench.server.commit(bench.now());
      REQUIRE(bench.commits(1).size() == before + 1);
    }
    REQUIRE(bench.ports.loads.size() <= 4);
    if (!bench.ports.loads.empty()) {  // a worker needs a millisecond for each chunk
      const ChunkKey key = bench.ports.loads.front();
      bench.ports.loads.pop_front();
      bench.server.chunk_loaded(key, dotted_chunk(kEdge), bench.now());
      ++loads_answered;
    }
    if (!arrived_at && sent_to(bench, 1).size() == 10) arrived_at = loads_answered;
    if (ms % 50 == 49) bench.server.tick(bench.now());
  }
  REQUIRE(arrived_at.has_value());
  CHECK(*arrived_at - *moved_at <= 4 + 2 * 5);  // those under way, then every other turn
  CHECK(loads_answered <= 1'000);

  const std::size_t first = bench.ports.snapshots.size();
  bench.tick();
  bench.answer_loads();
  std::set<ChunkKey> seen = sent_to(bench, 2, first);
  CHECK(seen.size() == cells_of(last));
  for (const ChunkKey& key : seen) CHECK(last.contains(key.at));
  CHECK(bench.server.resident_chunks() <= 10 + 1'000 + cells_of(last));
}

TEST_CASE("of the views that come within an interval the newest takes effect, at the next tick",
          "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.view(1, {{0, 0, 0}, 0, 0});
  REQUIRE(bench.ports.snapshots.size() == 1);  // the first one at once
  bench.view(1, {{10, 0, 0}, 1, 0});
  bench.view(1, {{20, 0, 0}, 1, 0});
  CHECK(bench.ports.snapshots.size() == 1);
  bench.tick();
  bench.answer_loads();
  const std::set<ChunkKey> sent = sent_to(bench, 1, 1);
  CHECK(sent.size() == 5);
  for (const ChunkKey& key : sent) CHECK(View{{20, 0, 0}, 1, 0}.contains(key.at));
}

TEST_CASE("what a client may have forgotten on the way to a view is sent again, the rest is not",
          "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  const View home{{0, 0, 0}, 2, 0};
  const View aside{{3, 0, 0}, 2, 0};
  bench.view(1, home);
  const std::size_t first = bench.ports.snapshots.size();
  REQUIRE(first == cells_of(home));
  bench.view(1, aside);
  bench.view(1, home);
  bench.tick();
  std::set<ChunkKey> expected = sent_to(bench, 1);
  std::erase_if(expected, [&](const ChunkKey& key) { return aside.contains(key.at); });
  CHECK(sent_to(bench, 1, first) == expected);
  CHECK(bench.ports.snapshots.size() == first + expected.size());
}

TEST_CASE("after more views on the way than are remembered everything is sent again", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  const View home{{0, 0, 0}, 1, 0};
  bench.view(1, home);
  for (std::uint8_t radius = 2; radius < 4; ++radius) {  // each holds all of home
    for (std::uint8_t height = 0; height < 6; ++height) bench.view(1, {{0, 0, 0}, radius, height});
  }
  bench.view(1, home);
  bench.tick();
  CHECK(bench.ports.snapshots.size() == 2 * cells_of(home));
}

TEST_CASE("a tick brings in so many chunks, and every session has its turn", "[world]") {
  WorldConfig c = config();
  c.view_chunks_per_tick = 1;  // one view a tick
  WorldBench bench(c);
  for (SessionId s = 1; s <= 4; ++s) bench.join(s, static_cast<std::uint8_t>(s));
  std::set<SessionId> served;
  for (int round = 0; round < 4; ++round) {
    for (SessionId s = 1; s <= 4; ++s) {
      bench.server.received(s, View{{static_cast<std::int32_t>(1000 * s) + round, 0, 0}, 0, 0},
                            bench.now());
    }
    const std::size_t before = bench.ports.snapshots.size();
    bench.tick();
    bench.answer_loads();
    CHECK(bench.ports.snapshots.size() - before <= 2);  // the first of all came at once
    for (std::size_t i = before; i < bench.ports.snapshots.size(); ++i) {
      served.insert(bench.ports.snapshots[i].session);
    }
  }
  CHECK(served == std::set<SessionId>{1, 2, 3, 4});
}

TEST_CASE("at a stop nothing is loaded any more but what snapshots need", "[world]") {
  WorldConfig c = config();
  c.loads_in_flight_max = 2;
  WorldBench bench(c);
  bench.join(1, 1);
  bench.server.received(1, View{{0, 0, 0}, 4, 4}, bench.now());
  REQUIRE(bench.ports.loads.size() == 2);
  const EditShape far = SetVoxel{{50 * kEdge, 0, 0}};
  bench.edit(1, 1, far);
  bench.server.begin_stop(bench.now());
  std::set<ChunkKey> loaded;
  while (!bench.ports.loads.empty()) {
    loaded.insert(bench.ports.loads.front());
    bench.server.chunk_loaded(bench.ports.loads.front(), dotted_chunk(kEdge), bench.now());
    bench.ports.loads.pop_front();
  }
  CHECK(loaded.size() == 3);
  CHECK(loaded.contains({0, {50, 0, 0}}));
  bench.server.durable(1, bench.now());
  REQUIRE(bench.ports.saves.size() == 1);
  bench.server.snapshots_saved(bench.now());
  CHECK(bench.server.is_settled());
}

}  // namespace
}  // namespace runstone
