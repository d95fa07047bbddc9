// Basin flood: the voxels that a liquid would fill from one place up to a level. It spreads through
// empty voxels, and through materials that let it pass, by steps along the axes, and never above
// the level. It reads runs and returns runs (line_flood.hpp). Pure. One thread.
#pragma once
#include <cstdint>
#include <vector>

#include "common/builds/build.hpp"
#include "common/builds/line_flood.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/runs/chunk_lookup.hpp"

namespace runstone {

struct BasinFlood {
  VoxelPos start;
  std::int32_t level = 0;        // the highest layer that is filled
  Material material = kEmpty;    // that fills; not empty
  std::uint64_t voxels_max = 0;  // of the basin, with those that are not empty
  /// By material: the flood spreads through its voxels, and leaves them as they are. Materials
  /// without an entry stop it. Empty voxels never do.
  std::vector<bool> passes;
};

/// The empty voxels of a basin as a build of the material that fills them.
struct FloodedBasin {
  BuildPtr build;
  VoxelPos at;               // of the corner of the build
  std::uint64_t voxels = 0;  // of the basin, with those that are not empty
};

enum class BasinFault : std::uint8_t {
  above_level,      // the start lies above the level
  blocked,          // the flood cannot be at the start
  missing_chunk,    // the basin reaches a chunk that is not known
  too_many_voxels,  // the basin has more than voxels_max, or its build takes too much memory
  full,             // no voxel of the basin is empty
};

/// Returns the basin around the start. The result does not depend on the axis orders of the chunks.
/// Requires chunks of `edge` voxels a side that stay as they are during the call. Cost: O(stretches
/// of the chunks that the basin reaches, and their runs) below the level; it stops soon after
/// voxels_max.
Result<FloodedBasin, BasinFault> flood_basin(const BasinFlood& flood, std::int32_t edge,
                                             const ChunkLookup& chunk_at);

}  // namespace runstone
