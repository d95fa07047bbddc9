// Layer diff: the layers in which two states of a chunk differ. The mesher needs them after any
// change: a prediction, a commit, a snapshot, or a prediction that is withdrawn.
#pragma once
#include "common/core/coords.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the layers in which a voxel differs. Requires equal extents. If both chunks have one
/// axis order, the result is exact and the cost is O(runs of both). In different orders the digests
/// decide between no layer and all layers.
DirtyLayers changed_layers(const RunChunk& before, const RunChunk& after);

/// Returns every layer of a chunk of this extent.
DirtyLayers all_layers(Extent extent);

/// Returns true if the layer that touches the neighbour in direction `d` is dirty. `side`: voxels
/// along the axis of d.
bool border_dirty(const DirtyLayers& dirty, Direction d, unsigned side);

}  // namespace runstone
