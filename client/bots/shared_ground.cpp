#include "client/bots/shared_ground.hpp"

namespace runstone {

void SharedGround::add(ChunkCoord at, const RunChunk& voxels) {
  if (chunks_ == kGroundChunksMax) return;
  edge_ = static_cast<std::int32_t>(voxels.extent.sides()[0]);
  if (columns_[{at.x, at.z}].try_emplace(at.y, voxels).second) ++chunks_;
}

std::optional<std::int32_t> SharedGround::surface(std::int32_t x, std::int32_t z) const {
  if (chunks_ == 0) return std::nullopt;
  const ChunkCoord in = chunk_of({x, 0, z}, edge_);
  const auto column = columns_.find({in.x, in.z});
  if (column == columns_.end()) return std::nullopt;
  for (const auto& [chunk_y, voxels] : column->second) {
    if (voxels.is_uniform() && material_at(voxels, {}) == kEmpty) continue;
    for (std::int32_t y = (chunk_y + 1) * edge_ - 1; y >= chunk_y * edge_; --y) {
      if (material_at(voxels, local_of({x, y, z}, edge_)) != kEmpty) return y;
    }
  }
  return std::nullopt;
}

}  // namespace runstone
