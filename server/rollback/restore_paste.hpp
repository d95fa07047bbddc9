// Restore pastes: edits that write the differences of a chunk. They are pasted clipboards in which
// all other cells are untouched, so that only the differences are written. A box that gets one
// material is a fill, which takes fewer bytes.
#pragma once
#include <span>
#include <vector>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/restore/restore.hpp"

namespace runstone {

/// Returns pastes that write the restored material of each difference, in the chunk whose first
/// voxel is `origin`. It is one paste, unless its clipboard would be larger than an edit may be.
/// Then the chunk is split along its slowest axis, and a single layer along the middle one. `now`
/// gives extent and axis order. Cost: O(runs of the clipboards + lines), for each level of splits.
std::vector<EditDescriptor> restore_pastes(const RunChunk& now,
                                           std::span<const Difference> differences,
                                           VoxelPos origin);

/// Returns pastes as restore_pastes(), in one group for each material that the differing voxels
/// hold in `now`. The mask of a group lets it write only where the voxel still holds that material.
/// The edit itself therefore leaves alone a voxel that was changed since `now`, whatever the
/// chunk's version is. There are more edits than from restore_pastes().
std::vector<EditDescriptor> careful_restore_pastes(const RunChunk& now,
                                                   std::span<const Difference> differences,
                                                   VoxelPos origin);

}  // namespace runstone
