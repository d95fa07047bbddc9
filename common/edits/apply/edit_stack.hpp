// The edit stack: all edits pending on a chunk, latest on top, applied in one sweep over its runs
// (thesis 9.2, stack-based edit indexing; 7.3.3, edit indices and edit areas). Server commit,
// client prediction, replay and rollback all call apply_stack(): same code, same result.
// Three searches find the changes, and all give the same result:
//   - a single edit is walked span by span (walk_changes() and walk_paste() in edit_sweep.hpp);
//   - a stack with an edit that covers whole layers is swept run by run (sweep_changes());
//   - any other stack is painted layer by layer (layer_painter.hpp).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/digest.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

struct ApplyResult {
  bool changed = false;  // any voxel has another material than before
  DirtyLayers dirty;     // the layers of these voxels, as mesh_rdm_layers() takes them
  // Maximal groups of replaced runs, ascending. `first` counts in the new runs.
  std::vector<EditArea> areas;
  std::uint64_t voxels_changed = 0;
};

/// Applies `edits`, bottom of the stack first, to the chunk whose first voxel is `origin`, and
/// updates the digest. The result is canonical, and equal to applying the edits one after another,
/// voxel by voxel. Edits that miss the chunk do nothing. The function works in two steps:
///   - Find the changes in ascending order. For one edit, walk the runs inside the edit's spans.
///     For several edits, make one pass (edit_sweep.hpp, layer_painter.hpp).
///   - Replace the runs of the edit areas, in place or all at once.
///
/// Requires a valid chunk and valid edits. Thread: any, with one scratch each. Cost: O(rows of the
/// edits + runs crossed + log runs) to search, O(runs behind the first edit area) to write.
ApplyResult apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                        std::span<const EditDescriptor> edits, ApplyScratch& scratch);

/// Applies edits as the form of apply_stack() that returns a result, into a `result` that the
/// caller reuses, so that a steady state allocates nothing.
void apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                 std::span<const EditDescriptor> edits, ApplyScratch& scratch, ApplyResult& result);

}  // namespace runstone
