// The edit sweep: finds the changes of a stack of edits in a chunk, in one ascending pass over
// layers, lines and runs. Of each voxel, only the edits from the topmost one without a mask upward
// matter, because that one overwrites the voxel. So in each layer the sweep scans the active set
// from the top of the stack. An edit is dropped if edits above it that have no mask cover it, and
// the scan ends when such edits cover the layer. The remaining edits of a line are evaluated from
// the bottom upward, masks in order. Where they cover the same voxels, this is done run by run.
// Otherwise it is done on the unpacked line, which has at most 128 voxels (thesis 7.3.3 unpacks its
// edit areas, too). Internal to edits.
#pragma once
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/change_tally.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Passes every stretch that scratch.stack changes to `tally`. The chunk does not change. Scratch:
/// O(edits + entries of one layer). Cost: O(runs crossed + rows of all edits * line length / 16 +
/// layers * edits / 64).
void sweep_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally);

/// Passes every stretch that a stack of one edit changes to `tally`. The edit may have several
/// parts. The function walks the runs inside each span. Cost: O(spans * log(runs between) + runs
/// crossed); for a stroke, also O(n log n) of the spans of its segments.
void walk_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally);

/// Passes every stretch that a paste changes to `tally`, without a stack: the boxes of a paste may
/// be as many as the voxels of the chunk. Requires an edit that is a paste. Cost: that of
/// placed_cells(), and O(runs crossed + lines of boxes that are not whole lines).
void walk_paste(const RunChunk& chunk, VoxelPos origin, const EditDescriptor& edit,
                ApplyScratch& scratch, ChangeTally& tally);

}  // namespace runstone
