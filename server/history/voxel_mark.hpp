// Voxel mark: the record of the log that set a voxel last. It blocks on the disk.
#pragma once
#include <cstddef>

#include "common/core/coords.hpp"
#include "common/generate/generator.hpp"
#include "server/store/world_reader.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

/// The number of records around a voxel after which no older window of the log is read.
inline constexpr std::size_t kVoxelMarkLooksMax = 16'384;

/// Returns the mark of the record that set this voxel last, or no mark:
///   - if no record of the log has set it;
///   - if its cause has no mark (kLogMarkCauseMax);
///   - if newer records with masks meet it and kVoxelMarkLooksMax records were read.
/// A record without a mask sets the voxels of its shape, also to the material that they have. A
/// record with a mask sets those that it changes. Requires a voxel of the world. Fails as the reader.
/// Cost: O(records near the voxel) from the end of the log to the newest record without a mask.
StoreResult<FoundLogMarks> read_voxel_mark(WorldReader& reader, const Generator& generator,
                                           VoxelPos at);

}  // namespace runstone
