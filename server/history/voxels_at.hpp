// Voxels of a box of a world as an array with one material a voxel, for programs that compute with
// arrays. Each chunk is read as runs; only the array is dense.
#pragma once
#include <cstdint>
#include <span>

#include "common/core/coords.hpp"
#include "server/history/world_at.hpp"

namespace runstone {

/// Writes the materials of the voxels of a box to `out`, as ids of the world. The z axis is the
/// fastest and the x axis the slowest: the voxel (x, y, z) of the box is at index
/// z + sides.z * (y + sides.y * x). The expansion is counted (dense.hpp).
/// Each reader reads the world of `world`, and works in a thread of its own; the call returns when
/// all of them have ended. The readers may not be inside begin_reads().
/// Requires at least one reader, a box inside the world that is not empty, and as many elements in
/// `out` as the box has voxels. Fails as WorldAt::voxels(), with the first error; `out` then has
/// any content. Cost: that of WorldAt::voxels() for each chunk, and O(voxels). Blocks on the disk.
StoreResult<void> read_voxels(const WorldAt& world, std::span<WorldReader* const> readers,
                              const VoxelBox& box, std::span<Material> out);

}  // namespace runstone
