// replaced(): the voxels of a box that a pattern changes, as a build.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/patterns/bound_filter.hpp"
#include "common/patterns/bound_mix.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/ground_columns.hpp"

namespace runstone {

/// The voxels that one call decides one by one: those that get a mix of several materials, and
/// those that `noise` takes.
inline constexpr std::uint64_t kPatternVoxelsMax = std::uint64_t{1} << 25;

/// Returns the build of exactly the voxels of the box that pass the filter and whose material
/// becomes another one; its other cells are untouched. Without a filter (null) all voxels pass.
/// Reads columns in slices. A filter sees the voxels one beyond the box as well; where they are not
/// known, they match nothing. Fails with
///   - not_found if a chunk of the box is not known;
///   - limit_exceeded if the build takes more than kBuildBytesMax, or more than kPatternVoxelsMax
///     voxels are decided one by one.
/// Requires a box that is not empty and lies in the world. Cost: O(runs + columns * chunks above
/// each other + voxels that are decided one by one).
Result<PlacedBuild> replaced(const VoxelBox& box, BoundMix& mix, BoundFilter* filter,
                             std::int32_t chunk_edge, const ChunkLookup& chunks);

}  // namespace runstone
