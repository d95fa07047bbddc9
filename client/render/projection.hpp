// Projection of places of the world to pixels of a frame, as the renderer draws them.
#pragma once
#include <array>
#include <cmath>
#include <optional>

#include "client/render/renderer.hpp"

namespace runstone {

struct ProjectedPoint {
  double x = 0, y = 0;  // pixels from the upper left corner; beside the frame if out of sight
  double distance = 0;  // voxels along the direction of sight
};

/// Returns the pixel of a place, or nullopt if the place is not in front of the eye. `size` is
/// width and height of the frame.
inline std::optional<ProjectedPoint> project(const Camera& camera, std::array<int, 2> size,
                                             double x, double y, double z) {
  const double sine = std::sin(camera.yaw), cosine = std::cos(camera.yaw);
  const double level = std::cos(camera.pitch), rise = std::sin(camera.pitch);
  const double dx = x - camera.x, dy = y - camera.y, dz = z - camera.z;
  // In right-handed coordinates with y up, -x is to the right of +z.
  const double right = -cosine * dx + sine * dz;
  const double forward = level * (sine * dx + cosine * dz) + rise * dy;
  const double up = level * dy - rise * (sine * dx + cosine * dz);
  if (forward < camera.near) return std::nullopt;
  const double half_height = size[1] / 2.0;
  const double pixels = half_height / std::tan(camera.fov_y / 2) / forward;
  return ProjectedPoint{size[0] / 2.0 + right * pixels, half_height - up * pixels, forward};
}

}  // namespace runstone
