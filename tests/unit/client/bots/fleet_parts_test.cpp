// What the bots of a fleet share, and when they act.
#include <catch2/catch.hpp>

#include "client/bots/due_times.hpp"
#include "client/bots/edit_schedule.hpp"
#include "client/bots/fleet_statistics.hpp"
#include "client/bots/shared_ground.hpp"

using namespace runstone;

TEST_CASE("due times are found by instance and sequence, for the newest edits of each",
          "[bots][headless]") {
  DueTimes due;
  for (ClientSequence seq = 1; seq <= 3; ++seq) due.add(7, seq, static_cast<TimeUs>(seq * 100));
  due.add(8, 1, 5);
  CHECK(due.find(7, 2) == 200);
  CHECK(due.find(8, 1) == 5);
  CHECK_FALSE(due.find(7, 4));
  CHECK_FALSE(due.find(9, 1));
  for (ClientSequence seq = 4; seq <= kLocalEditsMax + 1; ++seq) due.add(7, seq, 0);
  CHECK_FALSE(due.find(7, 1));
  CHECK(due.find(7, 2) == 200);
}

TEST_CASE("edits are due at fixed times from a phase on", "[bots]") {
  EditSchedule schedule(4, 0.5, 3);
  CHECK_FALSE(schedule.due_us());
  schedule.begin(1'000'000);
  for (const TimeUs due_us : {1'125'000, 1'375'000, 1'625'000}) {
    CHECK(schedule.due_us() == due_us);
    CHECK_FALSE(schedule.is_over());
    schedule.pass();
  }
  CHECK(schedule.is_over());
  CHECK_FALSE(schedule.due_us());
  EditSchedule endless(4, 0, std::nullopt);
  endless.begin(0);
  endless.end();
  CHECK(endless.is_over());
}

TEST_CASE("the shared ground is that of the first bot that saw it", "[bots][headless]") {
  SharedGround ground;
  CHECK_FALSE(ground.surface(0, 0));
  ground.add({0, -1, 0}, uniform_chunk(Extent::cube(16), 4));
  ground.add({0, 0, 0}, uniform_chunk(Extent::cube(16), kEmpty));
  CHECK(ground.surface(3, 3) == -1);
  CHECK_FALSE(ground.surface(-1, 3));
  RunChunk built = uniform_chunk(Extent::cube(16), kEmpty, AxisOrder::xyz);
  REQUIRE(fill(built, 0, 16, 2));  // the line y = 0, z = 0
  ground.add({0, 1, 0}, built);
  CHECK(ground.surface(3, 0) == 16);
  CHECK(ground.surface(3, 1) == -1);
  ground.add({0, 1, 0}, uniform_chunk(Extent::cube(16), 4));
  CHECK(ground.surface(3, 1) == -1);
  CHECK(ground.chunks() == 3);
}

TEST_CASE("fleet statistics keep every time, and the slowest of each second", "[bots][headless]") {
  FleetStatistics statistics;
  statistics.begin(1'000'000);
  statistics.see(1'000'000, 1'000'300);
  statistics.see(1'999'999, 2'500'000);
  statistics.see(3'000'000, 3'000'100);
  statistics.see(500'000, 900'000);  // due before the start
  statistics.see_unknown();
  CHECK(statistics.seen_us().count() == 4);
  CHECK(statistics.seen_us().max() == 500'001);
  CHECK(statistics.worst_us() == std::vector<TimeUs>{500'001, 0, 100});
  CHECK(statistics.unattributed() == 1);
}
