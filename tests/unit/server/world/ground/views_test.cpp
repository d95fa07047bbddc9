#include "server/world/ground/views.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

std::set<ChunkKey> sent_to(const WorldBench& bench, SessionId session, std::size_t first = 0) {
  std::set<ChunkKey> keys;
  for (std::size_t i = first; i < bench.environment.snapshots.size(); ++i) {
    if (bench.environment.snapshots[i].session == session)
      keys.insert(bench.environment.snapshots[i].key);
  }
  return keys;
}

std::size_t cells_of(const View& view) {
  std::vector<ChunkCoord> cells;
  append_difference(view, std::nullopt, {}, cells);
  return cells.size();
}

TEST_CASE("a client that moves its view each millisecond costs no loads and does not delay edits",
          "[world]") {
  WorldConfig c = config();
  c.loads_in_flight_max = 4;
  WorldBench bench(c);
  bench.join(1, 1);
  bench.join(2, 2);
  bench.view(1, kSmall);
  bench.environment.loads.clear();
  const View last{1, {9'000, 0, 0}, 4, 4};
  std::size_t loads_answered = 0;
  std::optional<std::size_t> moved_at, arrived_at;
  ClientSequence seq = 0;
  for (int ms = 0; ms < 1'000; ++ms) {
    bench.time_us += 1'000;
    bench.send_view(2, ms == 999 ? last : View{1, {100 + 20 * ms, 0, 0}, 4, 4});
    if (ms == 500) {  // the editor moves to five chunks that are not loaded
      bench.send_view(1, View{1, {-50, 0, 0}, 1, 0});
      moved_at = loads_answered;
    }
    if (ms % 10 == 0) {
      const std::size_t before = bench.commits(1).size();
      ++seq;
      bench.edit(1, seq, kAtOrigin, static_cast<Material>(1 + seq % 2));
      bench.server.commit(bench.now());
      REQUIRE(bench.commits(1).size() == before + 1);
    }
    REQUIRE(bench.environment.loads.size() <= 4);
    if (!bench.environment.loads.empty()) {  // a worker needs a millisecond for each chunk
      const ChunkKey key = bench.environment.loads.front();
      bench.environment.loads.pop_front();
      bench.server.chunk_loaded(key, dotted_chunk(kEdge), bench.now());
      ++loads_answered;
    }
    if (!arrived_at && sent_to(bench, 1).size() == 10) arrived_at = loads_answered;
    if (ms % 50 == 49) bench.server.tick(bench.now());
  }
  REQUIRE(arrived_at.has_value());
  CHECK(*arrived_at - *moved_at <= 4 + 2 * 5);  // the loads under way, then every other load
  CHECK(loads_answered <= 1'000);

  const std::size_t first = bench.environment.snapshots.size();
  bench.tick();
  bench.answer_loads();
  std::set<ChunkKey> seen = sent_to(bench, 2, first);
  CHECK(seen.size() == cells_of(last));
  for (const ChunkKey& key : seen) CHECK(last.contains(key.at));
  CHECK(bench.server.order().chunks().resident_count() <= 10 + 1'000 + cells_of(last));
}

TEST_CASE("of several views within an interval the newest takes effect on the next tick",
          "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.view(1, {1, {0, 0, 0}, 0, 0});
  REQUIRE(bench.environment.snapshots.size() == 1);  // the first view takes effect at once
  bench.view(1, {1, {10, 0, 0}, 1, 0});
  bench.view(1, {1, {20, 0, 0}, 1, 0});
  CHECK(bench.environment.snapshots.size() == 1);
  bench.tick();
  bench.answer_loads();
  const std::set<ChunkKey> sent = sent_to(bench, 1, 1);
  CHECK(sent.size() == 5);
  for (const ChunkKey& key : sent) CHECK(View{1, {20, 0, 0}, 1, 0}.contains(key.at));
}

TEST_CASE("chunks outside of a skipped view are sent again, other chunks are not", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  const View home{1, {0, 0, 0}, 2, 0};
  const View aside{1, {3, 0, 0}, 2, 0};
  bench.view(1, home);
  const std::size_t first = bench.environment.snapshots.size();
  REQUIRE(first == cells_of(home));
  bench.view(1, aside);
  bench.view(1, home);
  bench.tick();
  std::set<ChunkKey> expected = sent_to(bench, 1);
  std::erase_if(expected, [&](const ChunkKey& key) { return aside.contains(key.at); });
  CHECK(sent_to(bench, 1, first) == expected);
  CHECK(bench.environment.snapshots.size() == first + expected.size());
}

TEST_CASE("after too many skipped views every chunk is sent again", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  const View home{1, {0, 0, 0}, 1, 0};
  bench.view(1, home);
  for (std::uint8_t radius = 2; radius < 4; ++radius) {  // each contains all of home
    for (std::uint8_t height = 0; height < 6; ++height)
      bench.view(1, {1, {0, 0, 0}, radius, height});
  }
  bench.view(1, home);
  bench.tick();
  CHECK(bench.environment.snapshots.size() == 2 * cells_of(home));
}

TEST_CASE("views add a limited number of chunks on each tick, and every session is served",
          "[world]") {
  WorldConfig c = config();
  c.view_chunks_per_tick = 1;  // one view a tick
  WorldBench bench(c);
  for (SessionId s = 1; s <= 4; ++s) bench.join(s, static_cast<std::uint8_t>(s));
  std::set<SessionId> served;
  for (int round = 0; round < 4; ++round) {
    for (SessionId s = 1; s <= 4; ++s) {
      bench.send_view(s, View{1, {static_cast<std::int32_t>(1000 * s) + round, 0, 0}, 0, 0});
    }
    const std::size_t before = bench.environment.snapshots.size();
    bench.tick();
    bench.answer_loads();
    CHECK(bench.environment.snapshots.size() - before <= 2);  // the first view took effect at once
    for (std::size_t i = before; i < bench.environment.snapshots.size(); ++i) {
      served.insert(bench.environment.snapshots[i].session);
    }
  }
  CHECK(served == std::set<SessionId>{1, 2, 3, 4});
}

TEST_CASE("the chunks that a view leaves count like those that it adds", "[world]") {
  WorldConfig c = config();
  const View home{1, {0, 0, 0}, 4, 4};
  c.view_chunks_per_tick = 2 * cells_of(home);
  WorldBench bench(c);
  bench.has_empty_base = true;
  for (SessionId s = 1; s <= 2; ++s) {
    bench.join(s, static_cast<std::uint8_t>(s));
    bench.view(s, home);
    bench.tick();
  }
  const auto moved = [&] {
    std::size_t count = 0;
    for (const SessionId s : {1U, 2U}) {
      const auto states = bench.environment.messages<ViewState>(s, kEdge);
      if (!states.empty() && states.back().view == 2) ++count;
    }
    return count;
  };
  bench.tick(1'000'000);
  for (const SessionId s : {1U, 2U}) bench.view(s, {1, {100, 0, 0}, 4, 4});
  CHECK(moved() == 1);  // it left as many as it added
  bench.tick();
  bench.answer_loads();
  CHECK(moved() == 2);
}

TEST_CASE("a stop cancels all loads except those that snapshots need", "[world]") {
  WorldConfig c = config();
  c.loads_in_flight_max = 2;
  WorldBench bench(c);
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 4, 4});
  REQUIRE(bench.environment.loads.size() == 2);
  const EditShape far = SetVoxel{{50 * kEdge, 0, 0}};
  bench.edit(1, 1, far);
  bench.server.begin_stop(bench.now());
  std::set<ChunkKey> loaded;
  while (!bench.environment.loads.empty()) {
    loaded.insert(bench.environment.loads.front());
    bench.server.chunk_loaded(bench.environment.loads.front(), dotted_chunk(kEdge), bench.now());
    bench.environment.loads.pop_front();
  }
  CHECK(loaded.size() == 3);
  CHECK(loaded.contains({0, {50, 0, 0}}));
  bench.server.durable(1, bench.now());
  REQUIRE(bench.environment.saves.size() == 1);
  bench.server.snapshots_saved(bench.now());
  CHECK(bench.server.order().is_flushed());
}

TEST_CASE("answers carry the number of the view in force", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  for (const auto& sent : bench.environment.snapshots) CHECK(sent.view == 1);
  const std::size_t before = bench.environment.snapshots.size();
  bench.tick(2'000'000);
  bench.view(1, {2, {1, 0, 0}, 1, 0});
  REQUIRE(bench.environment.snapshots.size() > before);
  for (std::size_t i = before; i < bench.environment.snapshots.size(); ++i)
    CHECK(bench.environment.snapshots[i].view == 2);
}

TEST_CASE("numbers of views must ascend", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.server.received(1, View{7, {0, 0, 0}, 1, 0}, bench.now());
  CHECK(bench.environment.closed.empty());
  const std::uint32_t next = GENERATE(7u, 6u, 1u);
  bench.server.received(1, View{next, {0, 0, 0}, 1, 0}, bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::malformed_message);
}

TEST_CASE("each view is reported complete once, when all its chunks were answered", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  const auto complete = [&bench] {
    std::vector<std::uint32_t> views;
    for (const ViewState& state : bench.environment.messages<ViewState>(1, kEdge)) {
      CHECK(state.phase == ViewPhase::complete);
      CHECK_FALSE(state.past);
      views.push_back(state.view);
    }
    return views;
  };
  bench.send_view(1, kSmall);
  CHECK(complete().empty());  // its chunks are loaded
  bench.answer_loads();
  CHECK(complete() == std::vector<std::uint32_t>{1});
  bench.server.received(1, ChunkRequest{{{0, {0, 0, 0}}}}, bench.now());
  CHECK(complete() == std::vector<std::uint32_t>{1});  // the view was complete once
  bench.tick(2'000'000);
  View turned = kSmall;
  turned.cone = 1'000;
  bench.view(1, turned);
  CHECK(complete() == std::vector<std::uint32_t>{1, 2});
  SECTION("not while the queue is full") {
    bench.tick(2'000'000);
    bench.environment.snapshot_room[1] = 1;
    bench.view(1, {3, {50, 0, 0}, 1, 0});
    CHECK(complete().size() == 2);
    bench.environment.snapshot_room.clear();
    bench.server.drained(1, bench.now());
    CHECK(complete() == std::vector<std::uint32_t>{1, 2, 3});
  }
}

}  // namespace
}  // namespace runstone
