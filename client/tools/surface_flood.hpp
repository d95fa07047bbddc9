// Surface flood: the connected part of a surface that faces one direction. A voxel belongs to such
// a surface if it is not empty and the voxel in front of it is empty.
#pragma once
#include <cstddef>
#include <vector>

#include "client/replica/replica.hpp"
#include "common/core/coords.hpp"

namespace runstone {

struct SurfaceFlood {
  Direction face = Direction::pos_y;
  /// True: only voxels of the material of the first one.
  bool same_material = true;
  /// True: the surface may rise or fall by one voxel from a column to the next one.
  bool follows_steps = false;
  std::size_t voxels_max = 4096;
};

/// A surface ends at most this far from its first voxel along each axis, so that it fits a paste.
inline constexpr std::int32_t kSurfaceReach = 63;

/// Returns the voxels of the surface at `start`, nearest first (by steps), or nothing if `start` is
/// not on a surface of this face. The surface ends at chunks that are not shown. Requires an open
/// replica. Cost: O(voxels * log runs), and 256 KiB of scratch.
std::vector<VoxelPos> flood_surface(const Replica& replica, VoxelPos start,
                                    const SurfaceFlood& flood);

}  // namespace runstone
