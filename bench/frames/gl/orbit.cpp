#include "bench/frames/gl/orbit.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace runstone::bench {
namespace {

constexpr double kFovY = 1.0;                            // radians
constexpr double kPitchMean = 0.45, kPitchSwing = 0.35;  // radians below the horizon

std::array<double, 3> forward_of(const Camera& camera) {
  return {std::sin(camera.yaw) * std::cos(camera.pitch), std::sin(camera.pitch),
          std::cos(camera.yaw) * std::cos(camera.pitch)};
}

}  // namespace

Camera orbit_camera(const std::array<int, 3>& size, unsigned frame, unsigned frames) {
  const double turn = 2 * std::numbers::pi * frame / frames;
  const double radius = std::hypot(size[0], size[1], size[2]) / 2;
  Camera camera;
  camera.yaw = turn;
  camera.pitch = -(kPitchMean + kPitchSwing * std::sin(2 * turn));
  camera.fov_y = kFovY;
  const double distance = radius / std::sin(kFovY / 2);
  const auto forward = forward_of(camera);
  camera.x = size[0] / 2.0 - distance * forward[0];
  camera.y = size[1] / 2.0 - distance * forward[1];
  camera.z = size[2] / 2.0 - distance * forward[2];
  camera.near = distance - radius;
  camera.far = distance + radius;
  return camera;
}

glm::mat4 clip_of(const Camera& camera, int width, int height) {
  const auto forward = forward_of(camera);
  const glm::vec3 eye{static_cast<float>(camera.x), static_cast<float>(camera.y),
                      static_cast<float>(camera.z)};
  const glm::vec3 towards{static_cast<float>(forward[0]), static_cast<float>(forward[1]),
                          static_cast<float>(forward[2])};
  const glm::mat4 projection = glm::perspective(
      static_cast<float>(camera.fov_y), static_cast<float>(width) / static_cast<float>(height),
      static_cast<float>(camera.near), static_cast<float>(camera.far) * 1.1F);
  return projection * glm::lookAt(eye, eye + towards, glm::vec3{0, 1, 0});
}

}  // namespace runstone::bench
