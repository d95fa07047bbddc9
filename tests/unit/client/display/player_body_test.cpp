#include "client/display/player_body.hpp"

#include <catch2/catch.hpp>
#include <numbers>

using namespace runstone;

TEST_CASE("another player has feet below the eye, a direction, and a colour of its own",
          "[client_app]") {
  const WorldPos far_away{100, 0, 0};
  const auto ada = player_body(1, {{10, 20, 30}, 16384, -8192}, far_away);
  const auto bob = player_body(2, {{10, 20, 30}, 0, 0}, far_away);
  REQUIRE(ada.has_value());
  REQUIRE(bob.has_value());
  CHECK(ada->x == Approx(10));
  CHECK(ada->y == Approx(18.4));
  CHECK(ada->z == Approx(30));
  CHECK(ada->yaw == Approx(std::numbers::pi / 2));
  CHECK(ada->pitch == Approx(-std::numbers::pi / 4));
  CHECK((ada->r != bob->r || ada->g != bob->g || ada->b != bob->b));
}

TEST_CASE("the body of another player is not drawn if the eye is in it", "[client_app]") {
  const WorldPos other{10, 20, 30};
  const Pose pose{other, 0, 0};
  CHECK_FALSE(player_body(1, pose, other).has_value());            // both at the spawn
  CHECK_FALSE(player_body(1, pose, {10, 18.5, 30}).has_value());   // in the feet
  CHECK_FALSE(player_body(1, pose, {10.35, 20, 30}).has_value());  // nearer than the near plane
  CHECK(player_body(1, pose, {11, 20, 30}).has_value());
  CHECK(player_body(1, pose, {10, 21, 30}).has_value());
  CHECK(player_body(1, pose, {10, 20, 28}).has_value());
}
