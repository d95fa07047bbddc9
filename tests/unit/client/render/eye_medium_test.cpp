#include "client/render/eye_medium.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr double kFar = 400;
const glm::vec4 kOpen{0, 0, 0, 1};

MaterialInfo material(MaterialColour colour, Visibility visibility, MaterialBody body) {
  return {"test", colour, visibility, {}, body};
}

}  // namespace

TEST_CASE("an eye in a solid sees a dark fog of its colour within two voxels", "[render]") {
  const MaterialInfo red = material({200, 20, 20, 255}, Visibility::opaque, MaterialBody::solid);
  for (const double time : {0.0, 0.25, 0.5}) {
    const DayLight outside = day_light(time, kFar);
    const DayLight inside = light_inside(red, outside, kOpen);
    CHECK(inside.fog_end < 2);
    CHECK(inside.fog_start == 0);
    CHECK(inside.zenith == inside.horizon);
    CHECK(inside.zenith == inside.nadir);
    CHECK(inside.glow == glm::vec3{0});
    CHECK(inside.stars == 0);
    CHECK_FALSE(inside.has_clouds);
    CHECK(inside.zenith.r > inside.zenith.b);
    CHECK(inside.zenith.r < 0.1F);
  }
}

TEST_CASE("an eye in a liquid sees a short fog that is dark in a cave, and tinted light",
          "[render]") {
  const MaterialInfo water =
      material({30, 80, 220, 160}, Visibility::transparent, MaterialBody::liquid);
  const DayLight outside = day_light(0.5, kFar);
  const DayLight lake = light_inside(water, outside, kOpen);
  const DayLight cave = light_inside(water, outside, {0, 0, 0, 0});
  const DayLight lamp = light_inside(water, outside, {0.8F, 0.7F, 0.4F, 0});
  CHECK(lake.fog_end < 40);
  CHECK(lake.fog_end > 10);
  CHECK(lake.zenith.b > 2 * lake.zenith.r);
  CHECK(cave.zenith.b < 0.3F * lake.zenith.b);
  CHECK(lamp.zenith.b > cave.zenith.b);
  CHECK(lake.sun_colour.r < 0.7F * outside.sun_colour.r);
  CHECK(lake.sun_colour.b > 0.9F * outside.sun_colour.b);
}

TEST_CASE("glass and plants change nothing for an eye inside", "[render]") {
  const DayLight outside = day_light(0.5, kFar);
  for (const MaterialBody body : {MaterialBody::solid, MaterialBody::passable}) {
    const DayLight inside =
        light_inside(material({200, 255, 200, 80}, Visibility::transparent, body), outside, kOpen);
    CHECK(inside.fog_end == outside.fog_end);
    CHECK(inside.zenith == outside.zenith);
    CHECK(inside.sun_colour == outside.sun_colour);
  }
}
