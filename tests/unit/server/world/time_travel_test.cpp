#include "server/world/time_travel.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

struct TravelBench : WorldBench {
  void travel(SessionId session, std::uint32_t request, Sequence seq) {
    server.received(session, HistoryRequest{request, HistoryTarget::sequence, seq, 0}, now());
  }
  /// A worker has opened the oldest moment asked for.
  void open_one() {
    const auto [session, travel] = ports.moments.front();
    ports.moments.pop_front();
    server.moment_opened(session, travel.request, OpenedMoment{travel.seq, 1000}, now());
  }
  /// Workers make every chunk asked for; its version tells the moment, in steps of `step` edits.
  void load_all(Sequence step = 1) {
    while (!ports.past_loads.empty()) {
      const auto load = ports.past_loads.front();
      ports.past_loads.pop_front();
      Chunk chunk = dotted_chunk(kEdge);
      const Sequence seq = load.at / step * step;
      chunk.version = {seq == 0 ? 0U : 1U, seq};
      server.past_chunk(load.session, load.request, load.key, std::make_shared<const Chunk>(chunk),
                        now());
    }
  }
  std::vector<HistoryState> moments(SessionId session) const {
    return ports.messages<HistoryState>(session, kEdge);
  }
};

TEST_CASE("moments are opened a few at a time, and of a session's wishes the newest", "[world]") {
  TravelBench bench;
  for (SessionId session = 1; session <= 4; ++session) {
    bench.join(session, static_cast<std::uint8_t>(session));
    bench.view(session, kSmall);
  }
  for (SessionId session = 1; session <= 4; ++session) bench.travel(session, 1, 5);
  CHECK(bench.ports.moments.size() == kMomentsOpeningMax);
  bench.travel(1, 2, 6);
  bench.travel(1, 3, 7);
  CHECK(bench.ports.moments.size() == kMomentsOpeningMax);
  bench.open_one();  // session 1's first wish: nobody waits for it
  CHECK(bench.moments(1).empty());
  CHECK(bench.ports.past_loads.empty());
  CHECK(bench.ports.moments.back().second.request == 3);
  bench.open_one();  // session 2's
  CHECK(bench.moments(2).size() == 1);
  bench.tick();
  CHECK(bench.ports.moments.size() == kMomentsOpeningMax);  // those that waited have their turn
  bench.server.disconnected(1);
  while (!bench.ports.moments.empty()) {
    bench.open_one();
    bench.tick();
  }
  bench.load_all();
  for (SessionId session = 2; session <= 4; ++session) {
    const auto moments = bench.moments(session);
    REQUIRE(moments.size() == 2);
    CHECK(moments[0] == HistoryState{1, HistoryPhase::begins, true, 5, 1000, ""});
    CHECK(moments[1] == HistoryState{1, HistoryPhase::complete, true, 5, 0, ""});
  }
}

TEST_CASE(
    "who looks at the past gets no commit of others, and the world as it is when it comes back",
    "[world]") {
  TravelBench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.view(1, kSmall);
  bench.view(2, kSmall);
  bench.travel(1, 1, 0);
  bench.open_one();
  CHECK(bench.ports.past_loads.size() == 5);
  const std::size_t before = bench.ports.snapshots.size();
  bench.load_all();
  CHECK(bench.ports.snapshots.size() == before + 5);
  bench.edit(2, 1, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).empty());
  CHECK(bench.commits(2).size() == 1);
  bench.server.received(1, HistoryRequest{2, HistoryTarget::live, 0, 0}, bench.now());
  CHECK(bench.moments(1).back() == HistoryState{2, HistoryPhase::begins, false, 0, 0, ""});
  REQUIRE(bench.ports.snapshots.size() == before + 10);
  CHECK(bench.ports.snapshots.back().session == 1);
  bench.edit(2, 2, kAtOrigin, 2);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 1);
}

TEST_CASE("a chunk that is the same at the next moment is not sent again", "[world]") {
  TravelBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.travel(1, 1, 10);
  bench.open_one();
  bench.load_all(10);
  const std::size_t before = bench.ports.snapshots.size();
  bench.travel(1, 2, 14);
  bench.open_one();
  bench.load_all(10);  // all at version 10, as before
  CHECK(bench.ports.snapshots.size() == before);
  CHECK(bench.moments(1).back().phase == HistoryPhase::complete);
  CHECK(bench.moments(1).back().request == 2);
  bench.travel(1, 3, 20);
  bench.open_one();
  bench.load_all(10);
  CHECK(bench.ports.snapshots.size() == before + 5);
}

TEST_CASE("a full queue holds a moment and its chunks back, and loses none", "[world]") {
  TravelBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.ports.full.insert(1);
  bench.travel(1, 1, 3);
  bench.open_one();
  CHECK(bench.moments(1).empty());
  CHECK(bench.ports.past_loads.empty());
  bench.ports.full.clear();
  bench.ports.snapshot_room[1] = 2;
  bench.server.drained(1, bench.now());
  CHECK(bench.moments(1).size() == 1);
  const std::size_t before = bench.ports.snapshots.size();
  bench.load_all();
  CHECK(bench.ports.snapshots.size() == before + 2);
  bench.ports.snapshot_room.clear();
  bench.server.drained(1, bench.now());
  bench.load_all();
  CHECK(bench.ports.snapshots.size() == before + 5);
  CHECK(bench.moments(1).back().phase == HistoryPhase::complete);
}

TEST_CASE("a refused moment leaves a session where it is; a chunk that cannot be read is named",
          "[world]") {
  TravelBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.travel(1, 1, 99);
  bench.ports.moments.clear();
  bench.server.moment_opened(1, 1, Unexpected<std::string>{"no such edit"}, bench.now());
  CHECK(bench.moments(1).back() ==
        HistoryState{1, HistoryPhase::refused, false, 0, 0, "no such edit"});
  CHECK(bench.ports.past_loads.empty());

  bench.travel(1, 2, 3);
  bench.open_one();
  const auto load = bench.ports.past_loads.front();
  bench.ports.past_loads.pop_front();
  bench.server.past_chunk(1, load.request, load.key, Unexpected<std::string>{"row damaged"},
                          bench.now());
  const auto unavailable = bench.ports.messages<ChunkUnavailable>(1, kEdge);
  REQUIRE(unavailable.size() == 1);
  CHECK(unavailable[0].keys == std::vector<ChunkKey>{load.key});
  CHECK(bench.ports.lines.back().find("row damaged") != std::string::npos);
  bench.load_all();
  CHECK(bench.moments(1).back().phase == HistoryPhase::complete);
}

}  // namespace
}  // namespace runstone
