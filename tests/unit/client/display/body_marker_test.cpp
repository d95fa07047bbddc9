#include "client/display/body_marker.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("another player is a box around the eye, in a colour that depends on the player",
          "[client_app]") {
  const WorldPos far_away{100, 0, 0};
  const auto ada = body_marker(1, {10, 20, 30}, far_away);
  const auto bob = body_marker(2, {10, 20, 30}, far_away);
  REQUIRE(ada.has_value());
  REQUIRE(bob.has_value());
  CHECK(ada->filled);
  CHECK(ada->x == Approx(9.7));
  CHECK(ada->y == Approx(18.4));
  CHECK(ada->z == Approx(29.7));
  CHECK(ada->size_x == Approx(0.6));
  CHECK(ada->size_y == Approx(1.8));
  CHECK((ada->r != bob->r || ada->g != bob->g || ada->b != bob->b));
}

TEST_CASE("the box of another player is not drawn if the eye is in it", "[client_app]") {
  const WorldPos other{10, 20, 30};
  CHECK_FALSE(body_marker(1, other, other).has_value());            // both at the spawn
  CHECK_FALSE(body_marker(1, other, {10, 18.5, 30}).has_value());   // in the feet
  CHECK_FALSE(body_marker(1, other, {10.35, 20, 30}).has_value());  // nearer than the near plane
  CHECK(body_marker(1, other, {11, 20, 30}).has_value());
  CHECK(body_marker(1, other, {10, 21, 30}).has_value());
  CHECK(body_marker(1, other, {10, 20, 28}).has_value());
}
