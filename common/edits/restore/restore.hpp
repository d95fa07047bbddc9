// Restore: one chunk as it would be without the unbroken tail of selected writers of each voxel. A *writer* of
// a voxel is an edit that gave it another material; one that changed nothing is no writer, whatever its
// geometry. So what others built later stays, and what others built before comes back.
// How: two chunks in one axis order, equal at the start. Each edit, in log order, is applied to `now`. What it
// really changed there is written into `restored` too, stretch by stretch, unless the edit is selected.
// Why that is right: after every edit a voxel of `restored` holds what its last writer that is not selected
// wrote (or the start, if there is none), for exactly such writers write it. The writers after that one are all
// selected, so they are the tail, and the value is the one before the tail. Where the tail is empty, the last
// writer wrote both, and both hold the same.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Voxels [first, last) of the flattened chunk are all `now` and ought to be `restored`, which differs.
struct Difference {
  VoxelIndex first = 0, last = 0;
  Material now = kEmpty, restored = kEmpty;
  friend bool operator==(const Difference&, const Difference&) = default;
};

/// Appends where the two chunks differ: ascending, disjoint, each of one material before and after. Requires
/// one extent and axis order. O(runs of both).
void append_differences(const RunChunk& now, const RunChunk& restored,
                        std::vector<Difference>& out);

/// One chunk on its way through the log. One thread.
class ChunkRestore {
 public:
  /// `before`: the chunk whose first voxel is `origin`, as it stood before the first edit that is added.
  ChunkRestore(RunChunk before, VoxelPos origin);

  /// The next edit of the log that may touch the chunk; others may be left out. Requires a valid edit.
  /// Amortised the cost of apply_stack(); edits that are not selected are swept together until a selected
  /// one has changed something here.
  void add(const EditDescriptor& edit, bool is_selected, ApplyScratch& scratch);
  /// Takes in what add() has put off. Before the chunks are asked for.
  void settle(ApplyScratch& scratch);

  /// The chunk with all edits, and without the tails. Requires settle().
  const RunChunk& now() const { return now_; }
  const RunChunk& restored() const { return is_split_ ? restored_ : now_; }
  /// Whether they differ.
  bool has_differences() const { return is_split_; }

 private:
  void apply(std::span<const EditDescriptor> edits, bool is_selected, ApplyScratch& scratch);

  VoxelPos origin_;
  RunChunk now_, restored_;  // restored_ is kept while is_split_ only
  bool is_split_ = false;    // the two differ
  std::vector<EditDescriptor> pending_;
  bool pending_is_selected_ = false;
  Digest digest_;  // followed by apply_stack(); nobody asks for it
  ApplyResult result_;
};

}  // namespace runstone
