#include "client/render/day_light.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the light comes from above all day, and changes without jumps", "[render]") {
  constexpr int kMinutes = 1440;
  const auto at = [](int minute) { return day_light(static_cast<double>(minute) / kMinutes, 500); };
  DayLight before = at(-1);
  for (int minute = 0; minute < kMinutes; ++minute) {
    const DayLight now = at(minute);
    CAPTURE(minute);
    REQUIRE(now.sun_direction.y > 0.05F);
    REQUIRE(glm::length(now.sun_direction) == Approx(1).epsilon(1e-4));
    REQUIRE(glm::length(now.sun_colour - before.sun_colour) < 0.05F);
    REQUIRE(glm::length(now.zenith - before.zenith) < 0.02F);
    REQUIRE(std::abs(now.exposure - before.exposure) < 0.05F);
    // The direction jumps only from the sun to the moon and back, which both are dark then.
    if (glm::dot(now.sun_direction, before.sun_direction) < 0.99F)
      REQUIRE(glm::length(now.sun_colour) + glm::length(before.sun_colour) < 0.02F);
    before = now;
  }
  CHECK(at(720).sun_colour.g > 5 * at(0).sun_colour.g);
  CHECK(at(0).ambient_up.g > 0);
}

TEST_CASE("fog ends before the edge of view", "[render]") {
  CHECK(day_light(0.5, 100).fog_end < 100);
  CHECK(day_light(0.5, 100).fog_start < day_light(0.5, 100).fog_end);
}
