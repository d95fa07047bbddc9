// The layer painter: finds what a stack of edits changes in a chunk, layer by layer. The lines that a layer's
// edits meet are unpacked from the runs, the edits drawn on them from the bottom of the stack to its top, a
// vector of voxels at a time, and the result is compared with the runs again. Where shapes lie in lines is found
// for many lines at once (shape_lanes-inl.hpp). It keeps no list of rows per line as the edit sweep does, and
// hardly a branch depends on an edit; but a layer that an edit covers whole it draws voxel by voxel, where the
// sweep looks at runs alone. Internal to edits.
#pragma once
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/change_tally.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Hands every stretch that scratch.stack changes to `tally`: what sweep_changes() does, stretch by stretch the
/// same but for those that cross lines, which come line by line. Changes nothing itself. Scratch: one layer of
/// voxels (at most 32 KB), and for each part that meets a band of 32 layers at most 8.4 KB. O(rows of all edits +
/// runs crossed + lines met).
void paint_changes(const RunChunk& chunk, ApplyScratch& scratch, ChangeTally& tally);

}  // namespace runstone
