// Wand: finds the voxels that belong together.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "common/builds/line_flood.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/sculpt/voxel_rows.hpp"

namespace runstone {

struct WandSearch {
  /// The material of the voxels; nullopt: any but empty.
  std::optional<Material> material;
  std::uint64_t voxels_max = 0;
};

/// Returns the voxels that are connected with a start by steps along the axes. Fails with blocked
/// if the start has another material. Cost: that of LineFlood::run().
Result<VoxelRows, FloodFault> connected_voxels(const WandSearch& search, VoxelPos start,
                                               std::int32_t edge, const ChunkLookup& chunk_at);

/// Returns the voxels of boxes. Fails with blocked if there is none. Requires boxes that are not
/// empty and do not overlap. Cost: O(chunks of the boxes + their runs + stretches found); it stops
/// soon after voxels_max and at the first chunk that is not known.
Result<VoxelRows, FloodFault> voxels_of_boxes(const WandSearch& search,
                                              std::span<const VoxelBox> boxes, std::int32_t edge,
                                              const ChunkLookup& chunk_at);

}  // namespace runstone
