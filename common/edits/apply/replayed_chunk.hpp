// ReplayedChunk: a chunk that follows the log. Edits are collected on its stack, and each full
// stack is applied in one sweep. This is cheaper than one edit at a time, and a replay does not
// need the voxels after every edit.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/stack_depths.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

/// The maximum number of edits in one sweep. It bounds memory. A larger stack would save little
/// time (docs/performance.md).
inline constexpr std::size_t kReplayStackMax = 64;

/// The state that all replayed chunks of a thread share: buffers, and counts since it was made.
struct ReplayScratch {
  ApplyScratch apply;
  ApplyResult result;
  StackDepths depths;
  // Summed over sweeps. A voxel that an edit of one sweep changes and a later edit of the same
  // sweep restores is not counted.
  std::uint64_t voxels_changed = 0;
};

class ReplayedChunk {
 public:
  /// `origin`: the first voxel of the chunk in the world.
  ReplayedChunk(Chunk chunk, VoxelPos origin) : chunk_(std::move(chunk)), origin_(origin) {}

  /// Adds the next edit of the log that touches the chunk. The chunk takes `version`. Cost: that of
  /// apply_stack(), amortised.
  void add(const EditDescriptor& edit, Version version, ReplayScratch& scratch) {
    stack_.push_back(edit);
    chunk_.version = version;
    if (stack_.size() == kReplayStackMax) flush(scratch);
  }
  /// Applies the edits on the stack.
  void flush(ReplayScratch& scratch) {
    if (stack_.empty()) return;
    apply_stack(chunk_.voxels, chunk_.digest, origin_, stack_, scratch.apply, scratch.result);
    scratch.depths.add(stack_.size());
    scratch.voxels_changed += scratch.result.voxels_changed;
    has_changed_ = has_changed_ || scratch.result.changed;
    stack_.clear();
  }
  /// Returns true if any voxel changed since the last call. Requires an empty stack: call flush()
  /// first.
  bool take_changed() { return std::exchange(has_changed_, false); }

  /// The version includes edits that are still on the stack; voxels and digest do not.
  const Chunk& chunk() const { return chunk_; }
  Chunk& chunk() { return chunk_; }

 private:
  Chunk chunk_;
  VoxelPos origin_;
  std::vector<EditDescriptor> stack_;
  bool has_changed_ = false;
};

}  // namespace runstone
