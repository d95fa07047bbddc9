// Passing voxels: the voxels of boxes for which a filter holds, such as all of one material.
#pragma once
#include <cstdint>
#include <span>

#include "common/builds/line_flood.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/patterns/bound_filter.hpp"
#include "common/sculpt/voxel_rows.hpp"

namespace runstone {

/// Returns the voxels of boxes for which a filter holds. The result may be empty. A filter also
/// reads the layer of voxels around each box. Unknown voxels there match no filter. Fails with
/// missing_chunk if a chunk of a box is not known, and with too_many_voxels if more than voxels_max
/// pass. Requires boxes that are not empty, lie in the world and do not overlap, and a valid chunk
/// edge. Cost: O(runs + columns * chunks above each other + voxels found), plus the cost of
/// BoundFilter::passing() for each column. It stops soon after voxels_max, and at the first chunk
/// that is not known.
Result<VoxelRows, FloodFault> passing_voxels(std::span<const VoxelBox> boxes, BoundFilter filter,
                                             std::uint64_t voxels_max, std::int32_t chunk_edge,
                                             const ChunkLookup& chunks);

}  // namespace runstone
