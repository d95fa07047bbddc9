// Restore: one chunk without the effect of selected edits. A *writer* of a voxel is an edit that
// gave it another material. An edit that changed nothing is no writer, even if its geometry covers
// the voxel. Of each voxel, the unbroken tail of selected writers is removed. So later work of
// other authors stays, and earlier work of other authors returns.
//
// Method: two chunks in one axis order, equal at the start. Each edit, in log order, is applied to
// `now`. The changes that it made there are written into `restored` too, stretch by stretch, unless
// the edit is selected.
//
// Proof: after every edit, a voxel of `restored` holds the material of its last writer that is not
// selected, or the start if there is none, because exactly such writers write it. The writers after
// that one are all selected, so they are the tail, and the material is that before the tail. If the
// tail is empty, the last writer wrote both chunks, and both hold its material.
//
// Returns. An edit that takes a rollback back gives voxels the material that they had before that
// rollback, and with it the writers that they had then: the rollback and its undo are no writers of
// such a voxel. So the work of an author can be taken back, shown and found again after a rollback
// of it was undone. A return into a voxel that had another material then is a writer like any other.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Voxels [first, last) of the flattened chunk are all `now` and become `restored`, which differs.
struct Difference {
  VoxelIndex first = 0, last = 0;
  Material now = kEmpty, restored = kEmpty;
  friend bool operator==(const Difference&, const Difference&) = default;
};

/// Appends the differences of the two chunks: ascending, disjoint, each of one material before and
/// after. Requires one extent and axis order. Cost: O(runs of both).
void append_differences(const RunChunk& now, const RunChunk& restored,
                        std::vector<Difference>& out);

/// A chunk at a moment of the log, to which later edits may return.
struct RestorePoint {
  RunChunk now, restored;
};

/// One chunk that follows the log. Thread: one.
class ChunkRestore {
 public:
  /// `before`: the chunk, whose first voxel is `origin`, before the first added edit.
  ChunkRestore(RunChunk before, VoxelPos origin);
  using Point = RestorePoint;

  /// Adds the next edit of the log that may touch the chunk; other edits may be left out. Requires
  /// a valid edit. Edits that are not selected are applied together until a selected edit has
  /// changed something here. Cost: that of apply_stack(), amortised.
  void add(const EditDescriptor& edit, bool is_selected, ApplyScratch& scratch);
  /// Returns the chunk as it is before the next edit. Cost: O(runs), and that of flush().
  RestorePoint point(ApplyScratch& scratch);
  /// Adds the next edit, which is not selected and returns to `before`. Requires a point of this
  /// chunk. Cost: that of apply_stack(), and O(runs).
  void add_return(const EditDescriptor& edit, const RestorePoint& before, ApplyScratch& scratch);
  /// Applies the edits that add() has deferred. Call it before reading the chunks.
  void flush(ApplyScratch& scratch);

  /// Return the chunk with all edits, and the chunk without the tails. Requires flush().
  const RunChunk& now() const { return now_; }
  const RunChunk& restored() const { return is_split_ ? restored_ : now_; }
  /// Returns true if the two chunks differ.
  bool has_differences() const { return is_split_; }

 private:
  void apply(std::span<const EditDescriptor> edits, bool is_selected, ApplyScratch& scratch);

  VoxelPos origin_;
  RunChunk now_, restored_;  // restored_ is kept only while is_split_
  bool is_split_ = false;    // the two chunks differ
  std::vector<EditDescriptor> pending_;
  bool pending_is_selected_ = false;
  Digest digest_;  // updated by apply_stack(), not used
  ApplyResult result_;
};

}  // namespace runstone
