#include "client/render/sky_painter.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("clouds drift, have their place in the world, and stay above the eye", "[render]") {
  const glm::vec3 at_start = cloud_place({100, 70, 200}, 0);
  const glm::vec3 later = cloud_place({100, 70, 200}, 60);
  CHECK(later.x != at_start.x);
  CHECK(later.y == at_start.y);
  CHECK(later.z == at_start.z);
  CHECK(cloud_place({100, 71, 200}, 0).z < at_start.z);
  // An eye that climbs comes nearer to the clouds, but does not reach them.
  CHECK(cloud_place({0, 30'000, 0}, 0).z > 0);
  CHECK(cloud_place({0, 30'000, 0}, 0).z == cloud_place({0, 400, 0}, 0).z);
  // The place is exact far from the origin.
  for (const double far : {-2e9, 2e9}) {
    const glm::vec3 place = cloud_place({far, 0, far}, 3600);
    CHECK(place.x >= 0);
    CHECK(place.x <= 1);
    CHECK(place.y >= 0);
    CHECK(place.y <= 1);
  }
}
