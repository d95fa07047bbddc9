// copy_box(): copies the voxels that a replica shows inside a box to a build.
#pragma once
#include <cstddef>

#include "client/replica/replica.hpp"
#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns the shown voxels of a box of any size, predicted edits included. Every cell is touched;
/// empty voxels are empty cells. Copies chunk by chunk, run by run: each chunk becomes a section, and
/// uniform chunks share one. Fails with
///   - bad_value if the box is empty, if it reaches outside the world, or if no world is open;
///   - limit_exceeded if the build takes more than `bytes_max`;
///   - not_found if a chunk of the box is not shown.
/// Cost: O(chunks inside + their runs + lines of the chunks that the box cuts).
Result<BuildPtr> copy_box(const Replica& replica, const VoxelBox& box,
                          std::size_t bytes_max = kBuildBytesMax);

}  // namespace runstone
