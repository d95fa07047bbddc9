// GroundColumns: the voxels of a box of the world as columns. A column is the runs along y at one
// x and one z. Brushes that shape ground read it; they never expand a chunk to a grid.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/runs/chunk_lookup.hpp"

namespace runstone {

/// The columns that one reading takes at most: an area of 1024 x 1024 voxels.
inline constexpr std::int64_t kGroundColumnsMax = std::int64_t{1} << 20;

/// A run of a column by value. It covers the voxels from the end of the run below, or from the
/// bottom of the box, up to `end`, which it does not include.
struct ColumnRun {
  std::int32_t end = 0;
  Material material = kEmpty;
  friend bool operator==(const ColumnRun&, const ColumnRun&) = default;
};

class GroundColumns {
 public:
  /// Reads the columns of a box. Fails with limit_exceeded if it has more than kGroundColumnsMax
  /// columns. Requires a box that is not empty and lies in the world, and a valid chunk edge. Cost:
  /// O(runs of the chunks + columns * chunks above each other).
  static Result<GroundColumns> read(const VoxelBox& box, std::int32_t chunk_edge,
                                    const ChunkLookup& chunks);

  const VoxelBox& box() const { return box_; }
  std::int32_t width() const { return box_.max.x - box_.min.x; }
  std::int32_t depth() const { return box_.max.z - box_.min.z; }
  std::size_t count() const { return spans_.size(); }
  /// Returns the number of the column at a place of the box, by which column() finds it.
  std::size_t index(std::int32_t x, std::int32_t z) const {
    return static_cast<std::size_t>(x - box_.min.x) +
           static_cast<std::size_t>(width()) * static_cast<std::size_t>(z - box_.min.z);
  }
  /// Returns the runs of a column from below to above; neighbours differ, and the last one ends at
  /// the top of the box. Returns none if a chunk of the column is not known.
  std::span<const ColumnRun> column(std::size_t index) const {
    return std::span(runs_).subspan(spans_[index].first, spans_[index].count);
  }

 private:
  struct Span {
    std::size_t first = 0, count = 0;
  };
  void read_stack(std::int32_t chunk_x, std::int32_t chunk_z, std::int32_t edge,
                  const ChunkLookup& chunks);

  VoxelBox box_;
  std::vector<ColumnRun> runs_;
  std::vector<Span> spans_;  // by index()
};

/// Returns the material of a column at a height. Requires runs of a column that was read, and a
/// height inside the box. Cost: O(log runs).
Material material_in_column(std::span<const ColumnRun> column, std::int32_t y);

}  // namespace runstone
