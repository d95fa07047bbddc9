// Stand-in: a tile made from the octant of its parent, with each voxel doubled along each axis. It
// takes the place of a tile that has not arrived, where finer ground is shown below it.
#pragma once
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the stand-in for child `octant` of a tile (tile_child()), in the tile's axis order.
/// Requires a valid cube with an even edge of kSideMin * 2 or more. Cost: O(runs of the octant +
/// lines).
RunChunk stand_in(const RunChunk& parent, unsigned octant);

/// Returns one eighth of a tile: the voxels that child `octant` covers. Requires a valid cube with
/// an even edge of kSideMin * 2 or more.
RunChunk cut_octant(const RunChunk& tile, unsigned octant);

}  // namespace runstone
