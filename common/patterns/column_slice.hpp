// Column slices: the columns of a part of a box, as filters read them. Internal to patterns.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/sculpt/ground_columns.hpp"

namespace runstone {

/// The sides of the area of columns that is read at a time.
inline constexpr std::int32_t kColumnSliceEdge = 128;

/// Returns the box that is read for a part of a box. With `is_wide` it has one voxel more on each
/// side, inside the world.
VoxelBox slice_box(const VoxelBox& part, bool is_wide);

/// Reads the columns of `read`, a slice_box() of a part of `box`. Unknown voxels outside of `box`
/// get the last id, which matches no filter because only a full table has a material with this id.
/// Fails as GroundColumns::read() does.
Result<GroundColumns> read_column_slice(const VoxelBox& read, const VoxelBox& box,
                                        std::int32_t chunk_edge, const ChunkLookup& chunks);

}  // namespace runstone
