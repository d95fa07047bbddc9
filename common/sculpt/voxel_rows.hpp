// VoxelRows: a set of voxels anywhere in the world, as stretches of rows along x.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "common/builds/line_flood.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/row_stretches.hpp"

namespace runstone {

class VoxelRows {
 public:
  struct Place {
    std::int32_t z = 0, y = 0;
    friend auto operator<=>(const Place&, const Place&) = default;
  };

  /// Adds voxels of the row at y and z. Requires a stretch that is not empty. Cost: O(1) amortised.
  void add(std::int32_t y, std::int32_t z, RowStretch part);
  /// Joins stretches. Call it after the last add() and before the functions below.
  void join();

  bool empty() const { return rows_.empty(); }
  /// Returns the box of the voxels.
  const VoxelBox& box() const { return box_; }
  /// Returns the number of voxels. Cost: O(stretches).
  std::uint64_t count() const;
  /// Returns the number of stretches. Cost: O(rows).
  std::uint64_t stretches() const;
  /// Returns the stretches of a row, ascending and apart, or null if it has none.
  const std::vector<RowStretch>* row(std::int32_t y, std::int32_t z) const;
  /// Returns the places of the rows, ascending. Cost: O(rows log rows).
  std::vector<Place> places() const;
  bool contains(VoxelPos voxel) const;
  friend bool operator==(const VoxelRows& a, const VoxelRows& b) { return a.rows_ == b.rows_; }

 private:
  static std::uint64_t key_of(std::int32_t y, std::int32_t z) {
    return std::uint64_t{static_cast<std::uint32_t>(y)} << 32 | static_cast<std::uint32_t>(z);
  }
  std::unordered_map<std::uint64_t, std::vector<RowStretch>> rows_;
  VoxelBox box_;
};

using VoxelRowsPtr = std::shared_ptr<const VoxelRows>;

/// Returns the voxels of boxes. Cost: O(rows of the boxes log rows).
VoxelRows rows_of_boxes(std::span<const VoxelBox> boxes);
/// united() returns the voxels that are in one of the sets, without() the voxels of the first set
/// that are not in the second, and common() the voxels that are in both. Cost: O(stretches of both
/// sets).
VoxelRows united(const VoxelRows& a, const VoxelRows& b);
VoxelRows without(const VoxelRows& a, const VoxelRows& b);
VoxelRows common(const VoxelRows& a, const VoxelRows& b);
/// Returns the set moved by an offset. Cost: O(stretches).
VoxelRows moved(const VoxelRows& rows, VoxelPos by);
/// grown_to() returns the set and the voxels up to `steps` behind it in a direction. shrunk_from()
/// returns the voxels behind which all voxels up to `steps` in the direction are in the set.
/// Requires 0 <= steps. Cost: O(stretches of the result * log steps).
VoxelRows grown_to(const VoxelRows& rows, Direction direction, std::int32_t steps);
VoxelRows shrunk_from(const VoxelRows& rows, Direction direction, std::int32_t steps);

/// Returns the voxels at most `steps` away along each axis from a voxel of the set. Cost:
/// O(stretches * steps).
VoxelRows grown(const VoxelRows& rows, std::int32_t steps);

/// Returns the voxels around which all voxels up to `steps` away along each axis are in the set.
/// Cost: O(stretches * steps).
VoxelRows shrunk(const VoxelRows& rows, std::int32_t steps);

/// Returns a build of the voxels of the set that are not empty in the world, and with `with_air` of
/// the empty ones as well, with their materials; its other cells are untouched. Fails with bad_value
/// if it would have no voxel, with not_found if a chunk is not known, and with limit_exceeded if the
/// build takes too much memory. Requires chunks of `edge` voxels a side. Cost: O(stretches, and runs
/// of the chunks that they meet).
Result<PlacedBuild> build_of_voxels(const VoxelRows& rows, std::int32_t edge,
                                    const ChunkLookup& chunk_at, bool with_air = false);

}  // namespace runstone
