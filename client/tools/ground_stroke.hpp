// Ground strokes: what the stroke of a brush changes on the shown runs of a client. The terrain and
// path tools make their edits with it, and the ghosts of others are made with it, so both are equal
// where the shown runs are.
#pragma once
#include <cstdint>
#include <vector>

#include "client/replica/replica.hpp"
#include "client/tools/tool.hpp"
#include "client/tools/upright_chunks.hpp"
#include "common/materials/material_table.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/ground_columns.hpp"
#include "protocol/codec/brush_stroke.hpp"

namespace runstone {

/// Reads the shown columns of a box, as high and as low as chunks are shown at `place`. Fails with
/// words for the player.
Result<GroundColumns, std::string> read_shown_ground(const Replica& replica, VoxelBox box,
                                                     VoxelPos place, UprightChunks& upright);

/// Returns what a stroke changes, as an action: the voxels that the filter lets through, with the
/// materials of the mix. Distances are measured from the first place. Fails with words for the
/// player if nothing changes, the ground is not loaded, or a text has a mistake, or if the voxels
/// that change, times the bytes of the filter and the mix, are more than `pattern_work_max`.
/// Requires an open replica, at least one place, and numbers in the ranges of BrushStroke; the
/// number of places and the other work have no bound here. Cost: that of brush_changes() or
/// path_changes(), that of filtered() and that of mixed().
ToolEdits edits_of_stroke(const BrushStroke& stroke, const Replica& replica,
                          const MaterialTable& materials, UprightChunks& upright,
                          std::uint64_t pattern_work_max = UINT64_MAX);

}  // namespace runstone
