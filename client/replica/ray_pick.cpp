#include "client/replica/ray_pick.hpp"

#include <cmath>

namespace runstone {
namespace {

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

}  // namespace

LookDirection look_direction(double yaw, double pitch) {
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

std::optional<RayHit> pick(const Replica& replica, const ShapeTable& shapes, const WorldPos& eye,
                           const LookDirection& look, double reach,
                           const MaterialPredicate& passes) {
  if (!replica.opened()) return std::nullopt;
  ShownReader reader(replica);
  return first_hit([&reader](VoxelPos at) { return reader.at(at); }, shapes, eye, look, reach,
                   passes);
}

std::optional<VoxelPos> place_against(const RayHit& hit) {
  if (!hit.face) return std::nullopt;
  const ChunkCoord next = neighbour({hit.voxel.x, hit.voxel.y, hit.voxel.z}, *hit.face);
  return VoxelPos{next.x, next.y, next.z};
}

}  // namespace runstone
