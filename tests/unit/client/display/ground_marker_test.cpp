#include "client/display/ground_marker.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE(
    "a protected box is outlined in a colour and a form that say whether it admits the player",
    "[display]") {
  GroundBox box;
  box.box = {{-4, 0, 2}, {4, 10, 5}};
  const auto refuses = ground_marker(box, {0, 5, 0}, 100);
  REQUIRE(refuses.has_value());
  CHECK_FALSE(refuses->filled);
  CHECK((refuses->x == -4 && refuses->y == 0 && refuses->z == 2));
  CHECK((refuses->size_x == 8 && refuses->size_y == 10 && refuses->size_z == 3));
  CHECK(refuses->r > refuses->g);
  CHECK(refuses->crossed);
  box.admits = true;
  CHECK_FALSE(ground_marker(box, {0, 5, 0}, 100)->crossed);
  CHECK(ground_marker(box, {0, 5, 0}, 100)->g > ground_marker(box, {0, 5, 0}, 100)->r);
}

TEST_CASE("of a box that reaches through the world only the part near the eye is outlined",
          "[display]") {
  GroundBox box;
  box.box = {{0, -kWorldLimit, 0}, {16, kWorldLimit, 16}};
  const auto marker = ground_marker(box, {8, 1000, 8}, 100);
  REQUIRE(marker.has_value());
  CHECK(marker->y == 800);
  CHECK(marker->size_y == 400);
  CHECK(marker->size_x == 16);
  CHECK_FALSE(ground_marker(box, {200, 0, 0}, 100).has_value());
}

}  // namespace runstone::test
