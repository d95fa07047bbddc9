// ShownRuns: replaces the runs that a replica shows, and queues the change for the mesher: for the
// chunk itself, and for the neighbours at whose border a voxel changed. Every change of shown runs
// goes through here, also that of a chunk that the replica stops tracking. One thread.
#pragma once
#include <cstdint>
#include <span>

#include "client/replica/change_queue.hpp"
#include "client/replica/replica_chunks.hpp"

namespace runstone {

class ShownRuns {
 public:
  /// Both must outlive this object.
  ShownRuns(ReplicaChunks& chunks, ChangeQueue& changes) : chunks_(chunks), changes_(changes) {}
  ShownRuns(const ShownRuns&) = delete;
  ShownRuns& operator=(const ShownRuns&) = delete;

  /// Shows `next`, which contains the edits `cause` that were not shown before. Queues nothing if
  /// no voxel differs. Cost: O(runs of both).
  void show(TrackedChunk& chunk, ShownPtr next, std::span<EditChange* const> cause);
  /// Shows nothing any more. Queues the removal even if nothing was shown, because neighbours wait
  /// for the chunk.
  void hide(TrackedChunk& chunk);
  /// Queues the removal of a chunk that the replica is about to erase, if it is shown. Queues no
  /// change of its neighbours: their meshes are kept until their own voxels change.
  void forget(const TrackedChunk& chunk);

 private:
  void change_border(const ChunkKey& key, Direction side, const DirtyLayers& dirty,
                     std::span<EditChange* const> cause);

  ReplicaChunks& chunks_;
  ChangeQueue& changes_;
  std::uint64_t last_serial_ = 0;
};

}  // namespace runstone
