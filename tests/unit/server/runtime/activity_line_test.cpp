#include "server/runtime/activity_line.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the line of activity names only what moved, with units", "[server]") {
  ActivitySample before;
  before.world.edits_ordered = 100;
  before.bytes_out = 5'000;
  ActivitySample after = before;
  CHECK(activity_line(before, after, {4, 1}, 60) == "");
  after.world.sessions_opened = 1;
  after.world.edits_ordered = 1'304;
  after.bytes_out = 12'345'000;
  CHECK(activity_line(before, after, {4, 212'000'000}, 60) ==
        "in 60 s: 1 player came, 1204 edits, 12.3 MB sent; now 4 players, 212.0 MB of world in "
        "memory");
  after = before;
  after.world.edits_rejected = 3;
  CHECK(activity_line(before, after, {1, 0}, 10) ==
        "in 10 s: 3 edits refused; now 1 player, 0 bytes of world in memory");
}
