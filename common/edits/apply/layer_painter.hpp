// The layer painter: finds the changes of a stack of edits in a chunk, layer by layer. It unpacks
// the runs of the lines that the layer's edits meet. It draws the edits on these lines from the
// bottom of the stack to its top, a vector of voxels at a time. Then it compares the lines with the
// runs. The rows of a shape are found for many lines at once (shape_lanes-inl.hpp). Unlike the edit
// sweep, it keeps no list of rows per line, and few branches depend on an edit. But it draws a
// layer that an edit covers completely voxel by voxel, and the sweep visits only its runs. Internal
// to edits.
#pragma once
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/change_tally.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Passes every stretch that scratch.stack changes to `tally`. The stretches are those of
/// sweep_changes(), except that stretches end at the end of a line. The chunk does not change.
/// Scratch: one layer of voxels (at most 32 KB), and at most 8.4 KB for each part that meets a band
/// of 32 layers. Cost: O(rows of all edits + runs crossed + lines met).
void paint_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally);

}  // namespace runstone
