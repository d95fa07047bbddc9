// The edit sweep: finds what a stack of edits changes in a chunk, in one ascending pass over layers, lines
// and runs. Per layer, the active set is scanned from the top of the stack: an edit that everything above
// covers without a mask is dropped, and the scan ends when the layer is covered. What is left over of a line
// is evaluated from the bottom upward, masks in order: run by run where the edits cover the same voxels,
// otherwise on the unpacked line (at most 128 voxels; thesis 7.3.3 unpacks its edit areas likewise). Internal
// to edits.
#pragma once
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/change_tally.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Hands every stretch that scratch.stack changes to `tally`. Changes nothing itself. Scratch: O(edits +
/// entries of one layer). O(runs crossed + rows of all edits * line length / 16 + layers * edits / 64).
void sweep_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally);

/// The same for a stack that is one edit, be it in several parts: walks the runs inside each span. O(spans *
/// log(runs between) + runs crossed); for a stroke, also O(n log n) of the spans of its segments.
void walk_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally);

}  // namespace runstone
