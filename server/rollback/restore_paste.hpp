// Restore pastes: what differs in a chunk, as edits that write it: pasted clipboards whose other cells are
// untouched, so that nothing but the differences is written.
#pragma once
#include <span>
#include <vector>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/restore/restore.hpp"

namespace runstone {

/// Pastes that turn `now` into `restored` where they differ, in the chunk whose first voxel is `origin`. One, unless
/// its clipboard would be larger than an edit may be: then the chunk is split along its slowest axis (and a
/// single layer along the middle one). `now` gives extent and order. O(runs of what is built, per split).
std::vector<EditDescriptor> restore_pastes(const RunChunk& now,
                                           std::span<const Difference> differences,
                                           VoxelPos origin);

/// The same, one group for each material that differs now, each masked to write only where the voxel still
/// holds that material. So a voxel that was changed since `now` is left alone by the edit itself, whatever the
/// chunk's version. More edits, and safe without a look at the chunk.
std::vector<EditDescriptor> careful_restore_pastes(const RunChunk& now,
                                                   std::span<const Difference> differences,
                                                   VoxelPos origin);

}  // namespace runstone
