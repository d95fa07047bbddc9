// Voxel mark: the record of the log that set a voxel last. It blocks on the disk.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/generate/generator.hpp"
#include "server/store/world_reader.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

/// The cost after which no older window of the log is read (FoundLogMarks::cost). The whole cost of
/// a mark is at most about a tenth more, unless records of the last window have large clipboards.
inline constexpr std::uint64_t kVoxelMarkCostMax = 16'384;

/// Returns the mark of the record that set this voxel last, or no mark:
///   - if no record of the log has set it;
///   - if its cause has no mark (kLogMarkCauseMax);
///   - if the records that were read have masks, or do not meet it, and cost kVoxelMarkCostMax.
/// A record without a mask sets the voxels of its shape, also to the material that they have. A
/// record with a mask sets those that it changes. Requires a voxel of the world. Fails as the
/// reader. Cost: that of the records near the voxel from the end of the log to the newest one
/// without a mask, at most kVoxelMarkCostMax, and O(log edits) queries. Memory: 1 KiB for each unit
/// of the cost.
StoreResult<FoundLogMarks> read_voxel_mark(WorldReader& reader, const Generator& generator,
                                           VoxelPos at);

}  // namespace runstone
