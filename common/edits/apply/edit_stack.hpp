// The edit stack: all edits pending on a chunk, latest on top, applied in one sweep over its runs
// (thesis 9.2, stack-based edit indexing; 7.3.3, edit indices and edit areas). Server commit, client
// prediction, replay and rollback all call apply_stack(): same code, same result. Source of the evaluation:
// of each voxel, only the edits from the topmost unconditional one upward matter, since it overwrites
// whatever was there; masks above it are then tested in order.
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
  DirtyLayers dirty;
  std::vector<EditArea>
      areas;  // maximal groups of runs replaced, ascending; `first` counts in the new runs
  std::uint64_t voxels_changed = 0;
};

/// Applies `edits` (bottom of the stack first) to the chunk whose first voxel is `origin`; the digest
/// follows. Equal to applying them one after another, voxel by voxel, bit for bit. Edits that miss the chunk
/// do nothing. The result is canonical. Finds the changes first, in ascending order (one edit: by walking the
/// runs inside its spans; several: in one pass, edit_sweep.hpp and layer_painter.hpp), then replaces the runs of
/// the edit areas in place or in one go. Requires a valid chunk and valid edits. Any thread, one scratch each. Cost: O(rows of
/// the edits + runs crossed + log runs) to search, O(runs behind the first edit area) to write.
ApplyResult apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                        std::span<const EditDescriptor> edits, ApplyScratch& scratch);

/// The same, into a result that is reused: allocates nothing in a steady state.
void apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                 std::span<const EditDescriptor> edits, ApplyScratch& scratch, ApplyResult& result);

}  // namespace runstone
