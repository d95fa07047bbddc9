#include "client/replica/ray_pick.hpp"

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

/// Reads shown voxels. Keeps the chunk of the last voxel, because the next one is mostly in it.
class ShownReader {
 public:
  explicit ShownReader(const Replica& replica) : replica_(replica), edge_(replica.chunk_edge()) {}
  std::optional<Material> at(VoxelPos pos) {
    const ChunkCoord coord = chunk_of(pos, edge_);
    if (!chunk_ || coord != coord_) {
      coord_ = coord;
      chunk_ = replica_.shown({0, coord});
      if (!chunk_) return std::nullopt;
    }
    return material_at(*chunk_, local_of(pos, edge_));
  }

 private:
  const Replica& replica_;
  std::int32_t edge_;
  ChunkCoord coord_;
  ShownPtr chunk_;
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

LookDirection look_direction(double yaw, double pitch) {
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

std::optional<RayHit> pick(const Replica& replica, const ShapeTable& shapes, const WorldPos& eye,
                           const LookDirection& look, double reach,
                           const MaterialPredicate& passes) {
  if (!replica.opened() || !inside_world(eye)) return std::nullopt;
  std::array<AxisWalk, 3> walk = {AxisWalk{eye.x, look.x}, AxisWalk{eye.y, look.y},
                                  AxisWalk{eye.z, look.z}};
  ShownReader reader(replica);
  std::optional<Direction> face;
  double distance = 0;
  // Each iteration crosses one border, so the walk ends after about 3 * reach iterations at most.
  while (distance <= reach) {
    const VoxelPos at{walk[0].voxel, walk[1].voxel, walk[2].voxel};
    const auto material = reader.at(at);
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

std::optional<VoxelPos> place_against(const RayHit& hit) {
  if (!hit.face) return std::nullopt;
  const ChunkCoord next = neighbour({hit.voxel.x, hit.voxel.y, hit.voxel.z}, *hit.face);
  return VoxelPos{next.x, next.y, next.z};
}

}  // namespace runstone
