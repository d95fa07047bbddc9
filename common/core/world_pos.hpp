// WorldPos: a point in the world that is no whole voxel, and the displacement between two of them.
#pragma once

namespace runstone {

/// A point in the world, in voxels, for example the eye of a player. VoxelPos names a whole voxel.
struct WorldPos {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const WorldPos&, const WorldPos&) = default;
};

}  // namespace runstone
