// WorldPos: a point in the world that is no whole voxel, and the displacement between two of them.
#pragma once
#include <cmath>
#include <cstdint>

#include "common/core/coords.hpp"

namespace runstone {

/// A point in the world, in voxels, for example the eye of a player. VoxelPos names a whole voxel.
struct WorldPos {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const WorldPos&, const WorldPos&) = default;
};

/// Returns the voxel that holds a point. Requires a point in the world.
inline VoxelPos voxel_of_point(const WorldPos& at) {
  const auto whole = [](double c) { return static_cast<std::int32_t>(std::floor(c)); };
  return {whole(at.x), whole(at.y), whole(at.z)};
}

}  // namespace runstone
