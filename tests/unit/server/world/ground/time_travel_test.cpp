#include "server/world/ground/time_travel.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

WorldConfig without_view_interval() {
  WorldConfig c = config();
  c.view_interval_us = 0;
  return c;
}

struct HistoryBench : WorldBench {
  explicit HistoryBench(const WorldConfig& c = without_view_interval()) : WorldBench(c) {}

  void go_to(SessionId session, std::uint32_t request, Sequence seq) {
    server.received(session, HistoryRequest{request, HistoryTarget::sequence, seq, 0}, now());
  }
  /// Answers the oldest history request.
  void open_one() {
    const auto [session, request] = environment.history_requests.front();
    environment.history_requests.pop_front();
    server.ground().history_opened(session, request.request,
                                   OpenedHistory{request.seq, request.seq == 0 ? 0 : 1000}, now());
  }
  /// Answers every requested chunk of the past. Its version is the last multiple of `step` before
  /// the moment.
  void load_all(Sequence step = 1) {
    while (!environment.history_loads.empty()) {
      const auto load = environment.history_loads.front();
      environment.history_loads.pop_front();
      Chunk chunk = dotted_chunk(kEdge);
      const Sequence seq = load.at / step * step;
      chunk.version = {seq == 0 ? 0U : 1U, seq};
      server.ground().history_chunk_loaded(load.session, load.history, load.key,
                                           std::make_shared<const Chunk>(chunk), now());
    }
  }
  /// Returns the states that a session got after its live view was complete.
  std::vector<ViewState> states(SessionId session) const {
    std::vector<ViewState> all = environment.messages<ViewState>(session, kEdge);
    REQUIRE_FALSE(all.empty());
    CHECK(all.front() == ViewState{0, 1, ViewPhase::complete, false, 0, 0, ""});
    all.erase(all.begin());
    return all;
  }
};

TEST_CASE("few history requests are opened at a time, and of each session only the newest",
          "[world]") {
  HistoryBench bench;
  for (SessionId session = 1; session <= 4; ++session) {
    bench.join(session, static_cast<std::uint8_t>(session));
    bench.view(session, kSmall);
  }
  for (SessionId session = 1; session <= 4; ++session) bench.go_to(session, 1, 5);
  CHECK(bench.environment.history_requests.size() == kHistoriesOpeningMax);
  bench.go_to(1, 2, 6);
  bench.go_to(1, 3, 7);
  CHECK(bench.environment.history_requests.size() == kHistoriesOpeningMax);
  bench.open_one();  // session 1's first request, which was replaced
  CHECK(bench.states(1).empty());
  CHECK(bench.environment.history_loads.empty());
  CHECK(bench.environment.history_requests.back().second.request == 3);
  bench.open_one();  // session 2's request
  CHECK(bench.states(2).size() == 1);
  bench.tick();
  CHECK(bench.environment.history_requests.size() ==
        kHistoriesOpeningMax);  // requests that waited are opened
  bench.server.disconnected(1);
  while (!bench.environment.history_requests.empty()) {
    bench.open_one();
    bench.tick();
  }
  bench.load_all();
  for (SessionId session = 2; session <= 4; ++session) {
    const auto moments = bench.states(session);
    REQUIRE(moments.size() == 2);
    CHECK(moments[0] == ViewState{1, 1, ViewPhase::begins, true, 5, 1000, ""});
    CHECK(moments[1] == ViewState{1, 1, ViewPhase::complete, true, 5, 1000, ""});
  }
}

TEST_CASE("the moments of a session take effect as far apart as its views, the live world too",
          "[world]") {
  WorldConfig c = config();
  c.view_interval_us = 200'000;
  HistoryBench bench(c);
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.go_to(1, 1, 5);
  bench.open_one();
  bench.load_all();
  const std::size_t seen = bench.states(1).size();
  for (std::uint32_t request = 2; request < 9; ++request) {
    const bool is_live = request % 2 == 0;
    bench.server.received(
        1, HistoryRequest{request, is_live ? HistoryTarget::live : HistoryTarget::sequence, 0, 0},
        bench.now());
  }
  bench.server.received(1, HistoryRequest{9, HistoryTarget::live, 0, 0}, bench.now());
  bench.tick(199'999);
  CHECK(bench.environment.history_requests.empty());
  CHECK(bench.states(1).size() == seen);
  bench.tick(1);
  bench.answer_loads();
  REQUIRE(bench.states(1).size() == seen + 2);
  CHECK(bench.states(1).back() == ViewState{9, 1, ViewPhase::complete, false, 0, 0, ""});
}

TEST_CASE("a session in the past gets no commits, and gets the current world when it returns",
          "[world]") {
  HistoryBench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.view(1, kSmall);
  bench.view(2, kSmall);
  bench.go_to(1, 1, 0);
  bench.open_one();
  CHECK(bench.environment.history_loads.size() == 5);
  const std::size_t before = bench.environment.snapshots.size();
  bench.load_all();
  CHECK(bench.environment.snapshots.size() == before + 5);
  bench.edit(2, 1, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).empty());
  CHECK(bench.commits(2).size() == 1);
  bench.server.received(1, HistoryRequest{2, HistoryTarget::live, 0, 0}, bench.now());
  const auto states = bench.states(1);
  REQUIRE(states.size() == 4);
  CHECK(states[2] == ViewState{2, 1, ViewPhase::begins, false, 0, 0, ""});
  CHECK(states[3] == ViewState{2, 1, ViewPhase::complete, false, 0, 0, ""});
  REQUIRE(bench.environment.snapshots.size() == before + 10);
  CHECK(bench.environment.snapshots.back().session == 1);
  bench.edit(2, 2, kAtOrigin, 2);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 1);
}

TEST_CASE("a chunk that is equal in the next view of the past is not sent again", "[world]") {
  HistoryBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.go_to(1, 1, 10);
  bench.open_one();
  bench.load_all(10);
  const std::size_t before = bench.environment.snapshots.size();
  bench.go_to(1, 2, 14);
  bench.open_one();
  bench.load_all(10);  // every chunk is at version 10, as before
  CHECK(bench.environment.snapshots.size() == before);
  CHECK(bench.states(1).back().phase == ViewPhase::complete);
  CHECK(bench.states(1).back().request == 2);
  bench.go_to(1, 3, 20);
  bench.open_one();
  bench.load_all(10);
  CHECK(bench.environment.snapshots.size() == before + 5);
}

TEST_CASE("a full queue delays the view state and its chunks, and loses none", "[world]") {
  HistoryBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.environment.full.insert(1);
  bench.go_to(1, 1, 3);
  bench.open_one();
  CHECK(bench.states(1).empty());
  CHECK(bench.environment.history_loads.empty());
  bench.environment.full.clear();
  bench.environment.snapshot_room[1] = 2;
  bench.server.drained(1, bench.now());
  CHECK(bench.states(1).size() == 1);
  const std::size_t before = bench.environment.snapshots.size();
  bench.load_all();
  CHECK(bench.environment.snapshots.size() == before + 2);
  bench.environment.snapshot_room.clear();
  bench.server.drained(1, bench.now());
  bench.load_all();
  CHECK(bench.environment.snapshots.size() == before + 5);
  CHECK(bench.states(1).back().phase == ViewPhase::complete);
}

TEST_CASE(
    "a history request that fails changes no view, and a chunk that cannot be read is unavailable",
    "[world]") {
  HistoryBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.go_to(1, 1, 99);
  bench.environment.history_requests.clear();
  bench.server.ground().history_opened(1, 1, failure("no such edit"), bench.now());
  CHECK(bench.states(1).back() == ViewState{1, 1, ViewPhase::refused, false, 0, 0, "no such edit"});
  CHECK(bench.environment.history_loads.empty());

  bench.go_to(1, 2, 3);
  bench.open_one();
  const auto load = bench.environment.history_loads.front();
  bench.environment.history_loads.pop_front();
  bench.server.ground().history_chunk_loaded(1, load.history, load.key, failure("row damaged"),
                                             bench.now());
  const auto unavailable = bench.environment.messages<ChunkUnavailable>(1, kEdge);
  REQUIRE(unavailable.size() == 1);
  CHECK(unavailable[0].keys == std::vector<ChunkKey>{load.key});
  CHECK(bench.environment.lines.back().find("row damaged") != std::string::npos);
  bench.load_all();
  CHECK(bench.states(1).back().phase == ViewPhase::complete);
}

TEST_CASE("a refused request and a view that is complete describe the past that the session sees",
          "[world]") {
  HistoryBench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.go_to(1, 1, 5);
  bench.open_one();
  bench.load_all();
  bench.go_to(1, 2, 99);
  bench.environment.history_requests.clear();
  bench.server.ground().history_opened(1, 2, failure("no such edit"), bench.now());
  CHECK(bench.states(1).back() ==
        ViewState{2, 1, ViewPhase::refused, true, 5, 1000, "no such edit"});
  bench.tick(2'000'000);
  bench.view(1, {2, {1, 0, 0}, 1, 0});
  bench.load_all();
  CHECK(bench.states(1).back() == ViewState{2, 2, ViewPhase::complete, true, 5, 1000, ""});
}

}  // namespace
}  // namespace runstone
