// ReplayedChunk: a chunk that follows the log. Edits pile up on its stack, and each full stack is applied in one
// sweep: whoever replays a stretch of the log looks at the voxels now and then, not after every edit.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/stack_depths.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

/// Edits gathered for one sweep: bounds memory, and a sweep over more gains little (docs/performance.md).
inline constexpr std::size_t kFollowedEditsMax = 64;

/// What all followed chunks of a thread share: buffers, and counts since it was made.
struct FollowScratch {
  ApplyScratch apply;
  ApplyResult result;
  StackDepths depths;
  std::uint64_t voxels_changed =
      0;  // summed over sweeps: what an edit of one sweep sets and a later one resets is not in it
};

class ReplayedChunk {
 public:
  /// `origin`: its first voxel in the world.
  ReplayedChunk(Chunk chunk, VoxelPos origin) : chunk_(std::move(chunk)), origin_(origin) {}

  /// The next edit in the order of the log that touches the chunk, at its version. Amortised cost: as apply_stack().
  void add(const EditDescriptor& edit, Version version, FollowScratch& scratch) {
    stack_.push_back(edit);
    chunk_.version = version;
    if (stack_.size() == kFollowedEditsMax) settle(scratch);
  }
  /// Applies what waits.
  void settle(FollowScratch& scratch) {
    if (stack_.empty()) return;
    apply_stack(chunk_.voxels, chunk_.digest, origin_, stack_, scratch.apply, scratch.result);
    scratch.depths.add(stack_.size());
    scratch.voxels_changed += scratch.result.voxels_changed;
    has_changed_ = has_changed_ || scratch.result.changed;
    stack_.clear();
  }
  /// Whether any voxel changed since this was last asked. Settle first.
  bool take_changed() { return std::exchange(has_changed_, false); }

  /// Its version counts edits that still wait; its voxels and digest do not.
  const Chunk& chunk() const { return chunk_; }
  Chunk& chunk() { return chunk_; }

 private:
  Chunk chunk_;
  VoxelPos origin_;
  std::vector<EditDescriptor> stack_;
  bool has_changed_ = false;
};

}  // namespace runstone
