// Tests which sessions get the clock of the world, when they get it, and which records set it.
#include <catch2/catch.hpp>

#include "tests/unit/server/world/commit/feature_bench.hpp"

namespace runstone::test {
namespace {

constexpr WorldTime kDusk{75'600'000, 20};

struct WorldTimeBench : FeatureBench {
  using FeatureBench::FeatureBench;

  std::vector<WorldTime> times_of(SessionId session) const {
    return environment.messages<WorldTime>(session, kEdge);
  }
  void set(const WorldTime& time) {
    const auto record = server.changes().set_clock(time, 0, now());
    INFO((record ? "" : record.error()));
    REQUIRE(record.has_value());
  }
};

}  // namespace

TEST_CASE("the clock is set by a record, and clients learn it then and when they join",
          "[world][world_time]") {
  WorldTimeBench bench;
  bench.join_with(1, 1, kFeatureWorldTime);
  bench.join_with(2, 2, kFeatureMaterials);
  CHECK(bench.times_of(1).empty());  // nobody has set it
  bench.set(kDusk);
  REQUIRE(bench.environment.records.size() == 1);
  const EditRecord& record = bench.environment.records.back();
  CHECK(record.cause == Cause::clock);
  CHECK(validate_fields(record).has_value());
  CHECK(*world_time_of(record.edit) == kDusk);
  CHECK(bench.times_of(1) == std::vector{kDusk});
  CHECK(bench.times_of(2).empty());
  CHECK(bench.commits(1).empty());
  for (int i = 0; i < 20; ++i) bench.tick(1'000'000);
  CHECK(bench.times_of(1).size() == 1);  // it runs at the client
  bench.join_with(3, 3, kFeatureWorldTime);
  CHECK(bench.times_of(3) == std::vector{later(kDusk, 20'000'000)});
}

TEST_CASE("a wall clock that is set back does not move the time of the world",
          "[world][world_time]") {
  WorldTimeBench bench;
  bench.tick();
  bench.set(kDusk);
  bench.wall_error_us = -86'400'000'000;
  bench.tick(1'000'000);
  bench.join_with(1, 1, kFeatureWorldTime);
  CHECK(bench.times_of(1) == std::vector{later(kDusk, 1'000'000)});
  bench.wall_error_us = 86'400'000'000;
  bench.tick(1'000'000);
  bench.join_with(2, 2, kFeatureWorldTime);
  CHECK(bench.times_of(2) == std::vector{later(kDusk, 2'000'000)});
}

TEST_CASE("the clock is saved ahead while it runs, and as it is at a stop", "[world][world_time]") {
  WorldTimeBench bench;
  bench.tick();
  bench.set(kDusk);
  const TimeUs set_us = bench.time_us;
  bench.tick(60'000'000);
  REQUIRE(bench.environment.states.size() == 1);
  CHECK(bench.environment.states[0].clock == SavedClock{1, later(kDusk, 120'000'000)});
  bench.time_us += 5'000'000;
  bench.server.begin_stop(bench.now());
  REQUIRE(bench.environment.states.size() == 2);
  CHECK(bench.environment.states[1].clock == SavedClock{1, later(kDusk, bench.time_us - set_us)});
}

TEST_CASE("a clock that was set is saved with the next tick, and again until the log takes it",
          "[world][world_time]") {
  WorldTimeBench bench;
  bench.tick();
  bench.set(kDusk);
  bench.environment.log_room = false;
  bench.tick(50'000);
  CHECK(bench.environment.states.empty());
  bench.environment.log_room = true;
  bench.tick(50'000);
  REQUIRE(bench.environment.states.size() == 1);
  // It is ahead of the clock, so a crash before the next save does not set the clock back.
  CHECK(bench.environment.states[0].clock == SavedClock{1, later(kDusk, 60'100'000)});
  bench.tick(50'000);
  CHECK(bench.environment.states.size() == 1);
  bench.set({5, 1});
  bench.tick(50'000);
  REQUIRE(bench.environment.states.size() == 2);
  CHECK(bench.environment.states[1].clock->record == 2);
}

TEST_CASE("a world that starts again goes on with the saved time", "[world][world_time]") {
  WorldStart start;
  start.saved.clock = SavedClock{1, kDusk};
  WorldTimeBench bench(config(), start);
  bench.tick();
  bench.time_us += 3'000'000;
  bench.join_with(1, 1, kFeatureWorldTime);
  CHECK(bench.times_of(1) == std::vector{later(kDusk, 3'000'000)});
}

TEST_CASE("a server that owns no world saves nothing", "[world][world_time]") {
  WorldTimeBench bench;
  bench.tick();
  bench.set(kDusk);
  bench.environment.is_owner = false;
  bench.tick(120'000'000);
  CHECK(bench.environment.states.empty());
}

}  // namespace runstone::test
