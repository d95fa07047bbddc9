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

TEST_CASE("stars shine at night alone, and colours are lost at night alone", "[render]") {
  const auto at = [](double hour) { return day_light(hour / 24, 500); };
  for (const double hour : {8.0, 12.0, 16.0}) {
    CAPTURE(hour);
    CHECK(at(hour).stars == 0);
    CHECK(at(hour).night == 0);
    CHECK_FALSE(at(hour).is_moon);
  }
  for (const double hour : {0.0, 3.0, 22.0}) {
    CAPTURE(hour);
    CHECK(at(hour).stars == 1);
    CHECK(at(hour).night > 0.6F);
    CHECK(at(hour).is_moon);
  }
  for (int minute = 0; minute < 1440; ++minute) {
    CAPTURE(minute);
    REQUIRE(std::abs(at((minute + 1) / 60.0).stars - at(minute / 60.0).stars) < 0.05F);
    REQUIRE(std::abs(at((minute + 1) / 60.0).night - at(minute / 60.0).night) < 0.05F);
  }
}

TEST_CASE("a side in the shade has more than a third of the light of the ground", "[render]") {
  for (const double hour : {8.0, 10.0, 12.0, 15.0}) {
    const DayLight light = day_light(hour / 24, 500);
    const float ground =
        light.sun_direction.y * light.sun_colour.g + light.ambient_up.g + light.dark.g;
    const float side = light.ambient_side.g + light.dark.g;
    CAPTURE(hour);
    CHECK(3 * side > ground);
    CHECK(side < 0.8F * ground);  // so that steps are still seen
    CHECK(light.ambient_down.g < light.ambient_side.g);
  }
}

TEST_CASE("haze begins before terrain fades, and is thicker in the evening", "[render]") {
  for (const bool has_far_ground : {false, true}) {
    const DayLight noon = day_light(0.5, 4000, has_far_ground);
    CHECK(noon.fog_start < noon.fog_fade);
    CHECK(noon.fog_fade < noon.fog_end);
    CHECK(noon.haze > 0);
    CHECK(day_light(0.75, 4000, has_far_ground).haze > 1.2F * noon.haze);
  }
  // A farther view has the same air.
  CHECK(day_light(0.5, 30'000, true).haze == day_light(0.5, 20'000, true).haze);
}
