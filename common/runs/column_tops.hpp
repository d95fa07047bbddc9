// Column tops: the world as seen from above. A column has one x and one z, and its top is the
// highest voxel that shows. Tops are found directly from the runs of chunks. Visit chunks that lie
// above each other from the highest one down: each chunk closes the columns in which it finds a
// top.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The highest voxel of a column that shows.
struct ColumnTop {
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();

  std::int32_t y = kNone;  // of the world; kNone: nothing was found, the column is open
  Material material = kEmpty;

  bool is_found() const { return y != kNone; }
  friend bool operator==(const ColumnTop&, const ColumnTop&) = default;
};

/// True for each material that shows from above, by id. Ids beyond the end show.
using ShowingMaterials = std::vector<bool>;

/// Finds the tops of the open columns in a chunk whose lowest voxels are at `base_y`, and returns
/// how many it found. The column (x, z) of the chunk is tops[x + extent.x * z]. Requires extent.x *
/// extent.z columns, and that the closed ones were closed by chunks above this one. Cost: O(runs +
/// columns) if the lines of the chunk run along y, otherwise O(runs + lines + columns).
std::size_t find_column_tops(const RunChunk& chunk, std::int32_t base_y,
                             const ShowingMaterials& showing, std::span<ColumnTop> tops);

}  // namespace runstone
