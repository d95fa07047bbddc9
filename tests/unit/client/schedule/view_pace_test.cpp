#include "client/schedule/view_pace.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

/// A player and the view that follows, in virtual time.
struct Follower {
  /// Moves the player to chunk `x` at this time. Returns true if the view moved.
  bool turn(std::int32_t x, TimeUs now_us) {
    View next = view;
    next.centre.x = x;
    return look(next, now_us);
  }
  bool look(const View& next, TimeUs now_us) {
    if (!pace.step(view, next, now_us)) return false;
    view = next;
    return true;
  }
  ViewPace pace;
  View view{1, {0, 0, 0}, 4, 2, 0, 0, kSightCone};
};

}  // namespace

TEST_CASE("a view follows the first step at once and stays while its player stays", "[schedule]") {
  Follower follower;
  CHECK_FALSE(follower.turn(0, 0));
  CHECK(follower.turn(1, 1));
  CHECK_FALSE(follower.turn(1, 2));
  CHECK_FALSE(follower.turn(1, 10 * kViewEveryUs));
  CHECK(follower.turn(2, 10 * kViewEveryUs));  // after a rest the next step is due at once
}

TEST_CASE(
    "a player who crosses a chunk every millisecond moves the view ten times a second, "
    "and to the end",
    "[schedule]") {
  Follower follower;
  int moves = 0;
  TimeUs now_us = 0;
  for (std::int32_t x = 1; x <= 1'000; ++x, now_us += 1'000) {
    const bool moved = follower.turn(x, now_us);
    moves += moved ? 1 : 0;
    if (moved) CHECK(follower.view.centre.x == x);  // the newest position
  }
  CHECK(moves == 10);
  CHECK(follower.view.centre.x < 1'000);
  const TimeUs stopped_us = now_us;
  while (!follower.turn(1'000, now_us)) {
    now_us += 1'000;
    REQUIRE(now_us - stopped_us <= kViewEveryUs);
  }
  CHECK(follower.view.centre.x == 1'000);
  CHECK_FALSE(follower.turn(1'000, now_us + kViewEveryUs));
}

TEST_CASE(
    "a view follows a turn of more than fifteen degrees in either direction, and no smaller one",
    "[schedule]") {
  Follower follower;
  const auto turned = [&](std::uint16_t yaw, std::int16_t pitch, TimeUs now_us) {
    View next = follower.view;
    next.yaw = yaw;
    next.pitch = pitch;
    return follower.look(next, now_us);
  };
  CHECK_FALSE(turned(kViewTurn, 0, 0));
  CHECK_FALSE(turned(static_cast<std::uint16_t>(-kViewTurn), 0, 0));
  CHECK_FALSE(turned(0, -kViewTurn, 0));
  CHECK(turned(kViewTurn + 1, 0, 0));
  CHECK_FALSE(turned(20'000, 0, kViewEveryUs - 1));  // not yet
  CHECK(turned(20'000, 0, kViewEveryUs));
  CHECK(turned(20'000, -kViewTurn - 1, 2 * kViewEveryUs));
  follower.view.cone = 0;
  CHECK_FALSE(turned(0, 0, 9 * kViewEveryUs));  // a cone of 360 degrees has no direction
}
