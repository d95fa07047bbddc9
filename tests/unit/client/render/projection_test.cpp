#include "client/render/projection.hpp"

#include <catch2/catch.hpp>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace runstone;

TEST_CASE("a place is projected where the renderer's matrices put it", "[client_render]") {
  Camera camera;
  camera.x = 100;
  camera.y = 20;
  camera.z = -30;
  camera.yaw = 0.7;
  camera.pitch = -0.4;
  const std::array<int, 2> size{640, 360};
  // The matrices of Renderer::draw().
  const glm::dvec3 forward{std::sin(camera.yaw) * std::cos(camera.pitch), std::sin(camera.pitch),
                           std::cos(camera.yaw) * std::cos(camera.pitch)};
  const glm::dmat4 clip = glm::perspective(camera.fov_y, 640.0 / 360.0, camera.near, camera.far) *
                          glm::lookAt(glm::dvec3{0}, forward, glm::dvec3{0, 1, 0});
  for (const glm::dvec3 relative : {glm::dvec3{3, 1, 9}, {10, -6, 4}, {6, 0, 6}}) {
    const glm::dvec4 at = clip * glm::dvec4(relative, 1);
    REQUIRE(at.w > 0);
    const auto found =
        project(camera, size, camera.x + relative.x, camera.y + relative.y, camera.z + relative.z);
    REQUIRE(found.has_value());
    CHECK(found->x == Approx((at.x / at.w + 1) / 2 * 640));
    CHECK(found->y == Approx((1 - at.y / at.w) / 2 * 360));
    CHECK(found->distance == Approx(at.w));
  }
  CHECK_FALSE(project(camera, size, camera.x - 3, camera.y, camera.z - 9).has_value());
}
