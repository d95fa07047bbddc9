#include "client/display/smooth_players.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr TimeUs kMilli = 1'000;

OtherPlayer player_at(double x) { return {"ada", {}, Pose{{x, 0, 0}, 0, 0}}; }

}  // namespace

TEST_CASE("other players move between their poses", "[client_display]") {
  SmoothPlayers players;
  std::map<AuthorId, OtherPlayer> others{{3, player_at(0)}, {4, {"no pose yet", {}, {}}}};
  players.update(others, 0);
  REQUIRE(players.at(0).size() == 1);
  CHECK(players.at(0).at(3).at.x == 0);
  others[3] = player_at(1);
  players.update(others, 100 * kMilli);
  const double half = players.at(150 * kMilli).at(3).at.x;
  CHECK(half > 0);
  CHECK(half < 1);
  CHECK(players.at(2'000 * kMilli).at(3).at.x == 1);
}

TEST_CASE("players who stand still cost no frames", "[client_display]") {
  SmoothPlayers players;
  std::map<AuthorId, OtherPlayer> others{{3, player_at(0)}};
  players.update(others, 0);
  CHECK(players.take_moved(0));  // somebody came
  players.update(others, 10 * kMilli);
  CHECK_FALSE(players.take_moved(10 * kMilli));
  others[3] = player_at(1);
  TimeUs now = 100 * kMilli;
  for (; now < 3'000 * kMilli; now += 10 * kMilli) {
    players.update(others, now);
    if (!players.take_moved(now)) break;
  }
  CHECK(now > 200 * kMilli);
  CHECK(now < 500 * kMilli);
  CHECK(players.at(now).at(3).at.x == 1);
  CHECK_FALSE(players.take_moved(now + 10 * kMilli));
  others.clear();
  players.update(others, now + 20 * kMilli);
  CHECK(players.take_moved(now + 20 * kMilli));  // somebody left
  CHECK(players.at(now + 20 * kMilli).empty());
}
