#include "common/collision/ray_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace runstone {
namespace {

/// One axis of the walk: the current voxel, the direction, and the distances at which the ray
/// crosses voxel borders.
struct AxisWalk {
  AxisWalk(double from, double slope) {
    const double cell = std::floor(from);
    voxel = static_cast<std::int32_t>(cell);
    if (slope > 0) {
      step = 1;
      next = (cell + 1 - from) / slope;
      width = 1 / slope;
    } else if (slope < 0) {
      step = -1;
      next = (cell - from) / slope;
      width = -1 / slope;
    }
  }
  void advance() {
    voxel += step;
    next += width;
  }
  std::int32_t voxel = 0;
  std::int32_t step = 0;
  double next = std::numeric_limits<double>::infinity();
  double width = std::numeric_limits<double>::infinity();
};

/// Where a ray enters a box, or nullopt if it passes or the box lies behind the eye. A ray that
/// begins inside enters at 0, without a face.
struct BoxEntry {
  double distance = 0;
  std::optional<Direction> face;
};
std::optional<BoxEntry> entry_of(const std::array<double, 3>& from,
                                 const std::array<double, 3>& slope, const ShapeBox& box) {
  double enters = 0, leaves = std::numeric_limits<double>::infinity();
  BoxEntry out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double min = box.min[axis] / double{kShapeUnits};
    const double max = box.max[axis] / double{kShapeUnits};
    if (slope[axis] == 0) {
      if (from[axis] < min || from[axis] > max) return std::nullopt;
      continue;
    }
    const bool is_up = slope[axis] > 0;
    const double in = ((is_up ? min : max) - from[axis]) / slope[axis];
    if (in > enters) {
      enters = in;
      out.face = static_cast<Direction>(axis * 2 + (is_up ? 0U : 1U));
    }
    leaves = std::min(leaves, ((is_up ? max : min) - from[axis]) / slope[axis]);
  }
  if (enters > leaves) return std::nullopt;
  out.distance = enters;
  return out;
}

/// Returns where the ray first enters a box of the shape of a voxel.
std::optional<BoxEntry> entry_of(const WorldPos& eye, const LookDirection& look, VoxelPos at,
                                 const Shape& shape) {
  const std::array<double, 3> from = {eye.x - at.x, eye.y - at.y, eye.z - at.z};
  std::optional<BoxEntry> out;
  for (const ShapeBox& box : shape.boxes) {
    const auto entry = entry_of(from, {look.x, look.y, look.z}, box);
    if (entry && (!out || entry->distance < out->distance)) out = entry;
  }
  return out;
}

bool inside_world(const WorldPos& p) {
  const auto fits = [](double v) { return std::isfinite(v) && std::fabs(v) < kWorldLimit - 1024; };
  return fits(p.x) && fits(p.y) && fits(p.z);
}

}  // namespace

std::optional<RayHit> first_hit(const MaterialReader& read, const ShapeTable& shapes,
                                const WorldPos& eye, const LookDirection& look, double reach,
                                const MaterialPredicate& passes) {
  if (!inside_world(eye)) return std::nullopt;
  std::array<AxisWalk, 3> walk = {AxisWalk{eye.x, look.x}, AxisWalk{eye.y, look.y},
                                  AxisWalk{eye.z, look.z}};
  std::optional<Direction> face;
  double distance = 0;
  // Each iteration crosses one border, so the walk ends after about 3 * reach iterations at most.
  while (distance <= reach) {
    const VoxelPos at{walk[0].voxel, walk[1].voxel, walk[2].voxel};
    const auto material = read(at);
    if (!material) return std::nullopt;
    const bool is_passed = *material != kEmpty && passes && passes(*material);
    if (is_passed || shapes.is_cube(*material)) {
      if (!is_passed && *material != kEmpty) return RayHit{at, *material, face, distance};
    } else if (const auto entry = entry_of(eye, look, at, shapes[*material].shape);
               entry && entry->distance <= reach) {
      return RayHit{at, *material, entry->face, entry->distance};
    }
    std::size_t axis = walk[0].next <= walk[1].next ? 0 : 1;
    if (walk[2].next < walk[axis].next) axis = 2;
    distance = walk[axis].next;
    if (!std::isfinite(distance)) return std::nullopt;
    face = static_cast<Direction>(axis * 2 + (walk[axis].step < 0 ? 1U : 0U));
    walk[axis].advance();
  }
  return std::nullopt;
}

std::optional<RayHit> first_hit(const VoxelSpace& space, const ShapeTable& shapes,
                                const WorldPos& eye, const LookDirection& look, double reach,
                                const MaterialPredicate& passes) {
  const auto read = [&space](VoxelPos at) -> std::optional<Material> {
    const RunChunk* const chunk = space.chunk(chunk_of(at, space.edge()));
    if (chunk == nullptr) return std::nullopt;
    return material_at(*chunk, local_of(at, space.edge()));
  };
  return first_hit(read, shapes, eye, look, reach, passes);
}

}  // namespace runstone
