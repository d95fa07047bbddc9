#include "client/replica/ray_pick.hpp"

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

bool inside_world(const WorldPos& p) {
  const auto fits = [](double v) { return std::isfinite(v) && std::fabs(v) < kWorldLimit - 1024; };
  return fits(p.x) && fits(p.y) && fits(p.z);
}

}  // namespace

LookDirection look_direction(double yaw, double pitch) {
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

std::optional<RayHit> pick(const Replica& replica, const WorldPos& eye, const LookDirection& look,
                           double reach) {
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
    if (*material != kEmpty) return RayHit{at, *material, face, distance};
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
