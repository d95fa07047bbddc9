// ClumpNoise: a random number for each voxel, with the same bits on every machine. Neighbours tend
// to have the same number, in clumps about `size` voxels across. Each cell of a lattice of that
// size has a point and a number of its own, and a voxel has the number of the nearest of eight
// points around it. So every number is as frequent as in a table without clumps. Source: cellular
// noise (Worley 1996), with the points in the middle half of their cells.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"

namespace runstone {

/// Returns a number for a voxel that depends on nothing else but the key. Keys may be small numbers:
/// unlike with place_hash() of a place on the ground, two keys that differ in few bits do not give
/// the same numbers at other places. The numbers are pinned, so that a mix that is applied again
/// changes nothing.
/// voxel_hash() is voxel_hash_in() the column of the voxel.
inline std::uint64_t voxel_column_hash(std::uint64_t key, std::int32_t x, std::int32_t z) {
  const std::uint64_t xz =
      (std::uint64_t{static_cast<std::uint32_t>(x)} << 32) | static_cast<std::uint32_t>(z);
  return mix64(key ^ mix64(xz));
}
inline std::uint64_t voxel_hash_in(std::uint64_t column, std::uint32_t y) {
  return mix64(column + y);
}
inline std::uint64_t voxel_hash(std::uint64_t key, VoxelPos at) {
  return voxel_hash_in(voxel_column_hash(key, at.x, at.z), static_cast<std::uint32_t>(at.y));
}

class ClumpNoise {
 public:
  /// Requires 1 <= size <= kClumpSizeMax. With size 1 each voxel has a number of its own.
  ClumpNoise(std::uint64_t key, std::int32_t size) : key_(key), size_(size) {}

  /// Returns a number that is uniform in all 32 bits. Cost: O(1). It is less after a call for a
  /// voxel near by, because the points around are kept.
  std::uint32_t at(VoxelPos voxel);

 private:
  /// A point, in parts of a voxel.
  struct Point {
    std::int64_t x = 0, y = 0, z = 0;
    std::uint32_t number = 0;
  };
  void read_points(VoxelPos cell);

  std::uint64_t key_;
  std::int32_t size_;
  std::optional<VoxelPos> cell_;  // the lowest of the eight cells of points_
  std::array<Point, 8> points_;
};

}  // namespace runstone
