#include "server/draw/oblique_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

/// Radians. It is narrower than a player's field of view, so that towers do not seem to lean.
constexpr double kFovY = 0.8;
constexpr double kMargin = 0.94;      // part of the picture's sides that the box may fill
constexpr double kFogStart = 0.6;     // part of `far` at which the renderer's fog begins
constexpr double kNearPerFar = 5e-5;  // limit of the depth buffer's resolution
constexpr double kSmallestSide = 16;  // voxels

struct Vec {
  double x = 0, y = 0, z = 0;
};
double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Returns the corners of the box. A side shorter than `smallest` is extended to it on both ends.
/// The maximum of a VoxelBox is one past its last voxel, which is the corner in continuous
/// coordinates.
std::array<Vec, 8> corners_of(const VoxelBox& box, double smallest) {
  const auto side = [smallest](double min, double max) {
    const double missing = std::max(0.0, smallest - (max - min)) / 2;
    return std::array<double, 2>{min - missing, max + missing};
  };
  const auto x = side(box.min.x, box.max.x), y = side(box.min.y, box.max.y),
             z = side(box.min.z, box.max.z);
  std::array<Vec, 8> out;
  for (std::size_t i = 0; i < 8; ++i) out[i] = {x[i & 1], y[i >> 1 & 1], z[i >> 2]};
  return out;
}

/// The places of the eye from which all corners are inside the picture, on one of its axes. Corner
/// c is inside if |c.side - eye.side| <= slope * (c.depth - eye.depth). So the eye's side lies
/// between high - slope * depth and low + slope * depth of the eye's depth.
struct Wedge {
  double slope = 1, low = -std::numeric_limits<double>::infinity(), high = -low;
  void take(double side, double depth) {
    low = std::max(low, side - slope * depth);
    high = std::min(high, side + slope * depth);
  }
  /// Returns the greatest depth at which there is such a place.
  double depth() const { return (high - low) / (2 * slope); }
  double middle() const { return (low + high) / 2; }
};

}  // namespace

DrawCamera oblique_camera(const VoxelBox& box, PictureSize size, ViewDirection direction) {
  RUNSTONE_ASSERT(!box.empty());
  DrawCamera camera;
  camera.yaw = direction.yaw;
  camera.pitch = direction.pitch;
  camera.fov_y = kFovY;
  const double sy = std::sin(camera.yaw), cy = std::cos(camera.yaw);
  const double sp = std::sin(camera.pitch), cp = std::cos(camera.pitch);
  const Vec forward{sy * cp, sp, cy * cp};
  const Vec right{-cy, 0, sy};
  const Vec up{-sy * sp, cp, -cy * sp};
  Wedge across, along;
  along.slope = std::tan(camera.fov_y / 2) * kMargin;
  across.slope = along.slope * size.width / size.height;
  for (const Vec& corner : corners_of(box, kSmallestSide)) {
    const double depth = dot(corner, forward);
    across.take(dot(corner, right), depth);
    along.take(dot(corner, up), depth);
  }
  const double depth = std::min(across.depth(), along.depth());
  const double r = across.middle(), u = along.middle();
  camera.x = depth * forward.x + r * right.x + u * up.x;
  camera.y = depth * forward.y + r * right.y + u * up.y;
  camera.z = depth * forward.z + r * right.z + u * up.z;
  fit_distances(camera, box);
  return camera;
}

void fit_distances(DrawCamera& camera, const VoxelBox& box) {
  double farthest = 0;
  for (const Vec& corner : corners_of(box, 0)) {
    const Vec to{corner.x - camera.x, corner.y - camera.y, corner.z - camera.z};
    farthest = std::max(farthest, std::sqrt(dot(to, to)));
  }
  camera.far = std::clamp(farthest / kFogStart, 64.0, kDrawDistanceMax);
  camera.near = std::max(0.1, camera.far * kNearPerFar);
}

}  // namespace runstone
