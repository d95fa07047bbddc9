#include "client/schedule/view_pace.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

/// A player and the view that follows, in virtual time.
struct Follower {
  /// The player is in chunk `x` at this time. Whether the view moved.
  bool turn(std::int32_t x, TimeUs now_us) {
    if (!pace.step(view, {x, 0, 0}, now_us)) return false;
    view = {x, 0, 0};
    return true;
  }
  ViewPace pace;
  ChunkCoord view{0, 0, 0};
};

}  // namespace

TEST_CASE("a view follows the first step at once and stays where its player stays", "[schedule]") {
  Follower follower;
  CHECK_FALSE(follower.turn(0, 0));
  CHECK(follower.turn(1, 1));
  CHECK_FALSE(follower.turn(1, 2));
  CHECK_FALSE(follower.turn(1, 10 * kViewEveryUs));
  CHECK(follower.turn(2, 10 * kViewEveryUs));  // rest does not count against the next step
}

TEST_CASE("a player who crosses a chunk every millisecond moves the view ten times a second, and to the end",
          "[schedule]") {
  Follower follower;
  int moves = 0;
  TimeUs now_us = 0;
  for (std::int32_t x = 1; x <= 1'000; ++x, now_us += 1'000) {
    const bool moved = follower.turn(x, now_us);
    moves += moved ? 1 : 0;
    if (moved) CHECK(follower.view.x == x);  // the newest place, none in between
  }
  CHECK(moves == 10);
  CHECK(follower.view.x < 1'000);
  const TimeUs stopped_us = now_us;
  while (!follower.turn(1'000, now_us)) {
    now_us += 1'000;
    REQUIRE(now_us - stopped_us <= kViewEveryUs);
  }
  CHECK(follower.view.x == 1'000);
  CHECK_FALSE(follower.turn(1'000, now_us + kViewEveryUs));
}
