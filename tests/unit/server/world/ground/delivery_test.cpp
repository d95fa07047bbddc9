#include "server/world/ground/ground.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/support/codec/view_distance.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;
using Bench = WorldBench;

TEST_CASE("a view brings its chunks, nearest first, each once", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, {1, {2, 0, 1}, 3, 1});
  std::set<ChunkKey> keys;
  std::int64_t last = 0;
  for (const auto& s : bench.environment.snapshots) {
    const std::int64_t distance = distance2({1, {2, 0, 1}, 3, 1}, s.key.at);
    CHECK(distance >= last);  // the fake environment loads in order
    last = distance;
    CHECK(keys.insert(s.key).second);
  }
  CHECK(keys.size() == 29 * 3);
}

TEST_CASE("a view beyond the limit is reduced to it", "[world]") {
  WorldConfig c = config();
  c.view_radius_max = 1;
  Bench bench(c);
  bench.join(1, 1);
  bench.view(1, {1, {0, 0, 0}, 60, 60});
  CHECK(bench.environment.snapshots.size() == 5 * 3);
}

TEST_CASE("at most the allowed number of loads waits for one session", "[world]") {
  WorldConfig c = config();
  c.loads_per_session_max = 4;
  Bench bench(c);
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 4, 4});
  CHECK(bench.environment.loads.size() == 4);
  const ChunkKey key = bench.environment.loads.front();
  bench.environment.loads.pop_front();
  bench.server.chunk_loaded(key, test::dotted_chunk(kEdge), bench.now());
  CHECK(bench.environment.loads.size() == 4);
  CHECK(bench.environment.snapshots.size() == 1);
}

TEST_CASE("a view of many chunks in memory is sent in several tasks, and sessions take turns",
          "[world]") {
  WorldConfig c = config();
  c.view_radius_max = 8;
  Bench bench(c);
  for (SessionId s = 1; s <= 3; ++s) bench.join(s, static_cast<std::uint8_t>(s));
  const View wide{1, {0, 0, 0}, 8, 4};
  bench.view(1, wide);  // loads the chunks
  const auto sent_to = [&](SessionId session) {
    return std::ranges::count(bench.environment.snapshots, session,
                              &FakeEnvironment::SentSnapshot::session);
  };
  const auto all = sent_to(1);
  bench.send_view(2, wide);
  bench.send_view(3, wide);
  const auto first = sent_to(2);
  CHECK(first > 0);
  CHECK(3 * first < all);
  CHECK(sent_to(3) == first);
  for (int turns = 1; turns <= 2; ++turns) {
    bench.server.ground().deliver_next(bench.now());
    bench.server.ground().deliver_next(bench.now());
    CHECK(sent_to(2) == (1 + turns) * first);
    CHECK(sent_to(3) == (1 + turns) * first);
  }
  bench.answer_loads();
  CHECK_FALSE(bench.server.ground().has_deliveries());
  CHECK(sent_to(2) == all);
  CHECK(sent_to(3) == all);
}

TEST_CASE("a full queue stops snapshots, and they continue with the nearest missing one",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.environment.snapshot_room[1] = 2;
  bench.view(1, kSmall);
  CHECK(bench.environment.snapshots.size() == 2);
  bench.environment.snapshot_room[1] = 100;
  bench.tick(50'000);
  CHECK(bench.environment.snapshots.size() == 2);  // the retry interval has not passed
  bench.tick(60'000);
  CHECK(bench.environment.snapshots.size() == 5);
}

TEST_CASE("a chunk request sends chunks of the view again and ignores others", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.server.received(1, ChunkRequest{{{0, {0, 0, 0}}, {0, {40, 0, 0}}, {3, {0, 0, 0}}}},
                        bench.now());
  REQUIRE(bench.environment.snapshots.size() == 6);
  CHECK(bench.environment.snapshots[5].key == ChunkKey{});
  CHECK(bench.environment.loads.empty());
}

TEST_CASE("a quarantined chunk is logged, unavailable to every session, and never loaded again",
          "[world]") {
  Bench bench;
  const ChunkUnavailable expected{1, {ChunkKey{}}, UnavailableReason::damaged};
  const auto unavailable = [&](SessionId session) {
    return bench.environment.messages<ChunkUnavailable>(session, kEdge);
  };
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 0, 0});
  REQUIRE(bench.environment.loads.size() == 1);
  bench.environment.loads.clear();
  CHECK(unavailable(1).empty());
  bench.server.chunk_failed({}, LoadFailure::damaged,
                            "world.sqlite: snapshot chunk=0,0,0: bad checksum", bench.now());
  REQUIRE(bench.environment.lines.size() >= 1);
  CHECK(bench.environment.lines.back().find("snapshot chunk=0,0,0: bad checksum") !=
        std::string::npos);
  CHECK(unavailable(1) == std::vector{expected});
  bench.join(2, 2);
  bench.view(2, kSmall);
  bench.tick(500'000);
  CHECK(bench.environment.snapshots.size() == 4);
  CHECK(unavailable(2) == std::vector{expected});
  CHECK(unavailable(1).size() == 1);
  bench.server.received(1, ChunkRequest{{ChunkKey{}}}, bench.now());
  CHECK(unavailable(1).size() == 2);
  CHECK(bench.environment.loads.empty());
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.server.order().head() == 1);  // it is ordered, logged and answered
  CHECK(bench.commits(1).size() == 1);
}

TEST_CASE("a chunk that could not be read is loaded again later, and then arrives", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 0, 0});
  for (TimeUs pause_us = 1'000'000; pause_us <= 32'000'000; pause_us *= 2) {
    CAPTURE(pause_us);
    REQUIRE(bench.environment.loads.size() == 1);
    bench.environment.loads.clear();
    bench.server.chunk_failed({}, LoadFailure::not_read, "too many open files", bench.now());
    CHECK(bench.environment.lines.back().find("too many open files") != std::string::npos);
    bench.server.received(1, Ping{1}, bench.now());  // the client is not silent
    bench.tick(pause_us - 50'000);
    CHECK(bench.environment.loads.empty());
    bench.server.received(1, Ping{1}, bench.now());
    bench.tick();
  }
  CHECK(bench.environment.messages<ChunkUnavailable>(1, kEdge).empty());
  bench.answer_loads();
  CHECK(bench.environment.snapshots.size() == 1);
}

TEST_CASE("a chunk that could not be read seven times in a row is quarantined", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 0, 0});
  for (int failure = 0; failure < 7; ++failure) {
    REQUIRE(bench.environment.loads.size() == 1);
    bench.environment.loads.clear();
    bench.server.chunk_failed({}, LoadFailure::not_read, "no such device", bench.now());
    // No message comes from the client meanwhile, but enough pings that it stays.
    for (int second = 0; second < 33; ++second) {
      bench.server.received(1, Ping{1}, bench.now());
      bench.tick(1'000'000);
    }
  }
  CHECK(bench.environment.loads.empty());
  CHECK(bench.environment.messages<ChunkUnavailable>(1, kEdge).size() == 1);
  CHECK(bench.environment.lines.back().find("quarantined: no such device") != std::string::npos);
}

TEST_CASE("a stop does not wait for a chunk that cannot be read", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  bench.server.durable(1, bench.now());
  bench.send_view(1, View{1, {0, 0, 0}, 0, 0});
  REQUIRE(bench.environment.loads.size() == 1);
  bench.environment.loads.clear();
  bench.server.chunk_failed({}, LoadFailure::not_read, "too many open files", bench.now());
  CHECK_FALSE(bench.server.order().is_flushed());
  bench.server.begin_stop(bench.now());
  REQUIRE(bench.environment.loads.size() == 1);  // at once, a last time
  bench.environment.loads.clear();
  bench.server.chunk_failed({}, LoadFailure::not_read, "too many open files", bench.now());
  for (const auto& save : std::exchange(bench.environment.saves, {})) {
    CHECK(save.chunks.empty());
    bench.server.snapshots_saved(bench.now());
  }
  CHECK(bench.server.order().is_flushed());
}

TEST_CASE("a loaded chunk that contradicts the log is unavailable", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 0, 0});
  bench.environment.loads.clear();
  bench.server.chunk_loaded({}, test::empty_chunk(32), bench.now());
  CHECK(bench.environment.messages<ChunkUnavailable>(1, kEdge).size() == 1);
  CHECK(bench.environment.snapshots.empty());
}

TEST_CASE("chunk unavailable waits for room like a snapshot", "[world]") {
  Bench bench;
  const auto unavailable_count = [&] {
    return bench.environment.messages<ChunkUnavailable>(1, kEdge).size();
  };
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 0, 0});
  bench.environment.loads.clear();
  bench.environment.full.insert(1);
  bench.server.chunk_failed({}, LoadFailure::damaged, "damaged", bench.now());
  CHECK(unavailable_count() == 0);
  bench.environment.full.clear();
  bench.server.drained(1, bench.now());
  CHECK(unavailable_count() == 1);
  bench.tick(500'000);
  CHECK(unavailable_count() == 1);
}

}  // namespace
}  // namespace runstone
