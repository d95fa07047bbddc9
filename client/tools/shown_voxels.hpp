// ShownVoxels: reads single shown voxels of a replica. It keeps the chunk of the last voxel,
// because the next voxel is usually in the same chunk. One thread.
#pragma once
#include <optional>

#include "client/replica/replica.hpp"
#include "common/core/assert.hpp"
#include "common/core/coords.hpp"

namespace runstone {

class ShownVoxels {
 public:
  /// Requires an open replica. It must outlive this object, and must not change during its life.
  explicit ShownVoxels(const Replica& replica) : replica_(replica), edge_(replica.chunk_edge()) {
    RUNSTONE_ASSERT(edge_ > 0);
  }

  /// Returns the material of a voxel, or nullopt if its chunk is not shown. Cost: O(log runs).
  std::optional<Material> at(VoxelPos voxel) {
    const ChunkCoord coord = chunk_of(voxel, edge_);
    if (!is_read_ || coord != coord_) {
      coord_ = coord;
      chunk_ = replica_.shown({0, coord});
      is_read_ = true;
    }
    if (!chunk_) return std::nullopt;
    return material_at(*chunk_, local_of(voxel, edge_));
  }

 private:
  const Replica& replica_;
  const std::int32_t edge_;
  ChunkCoord coord_;
  ShownPtr chunk_;
  bool is_read_ = false;
};

}  // namespace runstone
