// Layer diff: in which layers do two states of a chunk differ? What the mesher needs to know of any change,
// however it came about (own prediction, commit, snapshot, a prediction taken back).
#pragma once
#include "common/core/coords.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Layers in which a voxel differs. Exact when both chunks have one axis order: a walk over both run lists,
/// O(runs of both). In different orders the digests decide between "none" and "all". Requires equal extents.
DirtyLayers changed_layers(const RunChunk& before, const RunChunk& after);

/// Every layer of a chunk of this extent.
DirtyLayers all_layers(Extent extent);

/// Whether the layer that touches the neighbour in direction `d` is dirty. `side`: voxels along the axis of
/// d.
bool border_dirty(const DirtyLayers& dirty, Direction d, unsigned side);

}  // namespace runstone
