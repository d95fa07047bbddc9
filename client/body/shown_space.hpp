// ShownSpace: the shown runs of a replica as the space in which a player moves. One thread.
#pragma once
#include "client/replica/replica.hpp"
#include "common/collision/voxel_space.hpp"

namespace runstone {

class ShownSpace final : public VoxelSpace {
 public:
  /// Requires an open replica, which must outlive the space.
  explicit ShownSpace(const Replica& replica)
      : VoxelSpace(replica.chunk_edge()), replica_(replica) {}

  /// Returns null for a chunk that is not shown, also beyond the world.
  const RunChunk* chunk(ChunkCoord at) const override {
    if (!is_read_ || at != at_) {
      shown_ = replica_.shown({0, at});
      at_ = at;
      is_read_ = true;
    }
    return shown_.get();
  }

 private:
  const Replica& replica_;
  // The chunk that was read last: most reads are of the chunk of the read before.
  mutable ShownPtr shown_;
  mutable ChunkCoord at_;
  mutable bool is_read_ = false;
};

}  // namespace runstone
