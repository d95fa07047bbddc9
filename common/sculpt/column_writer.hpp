// ColumnWriter: the voxels of one column before a brush, and its changes. For the code of brushes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/ids.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/ground_columns.hpp"

namespace runstone {

class ColumnWriter {
 public:
  /// Appends to `out`, whose last changes are those of columns before. Requires a column that was
  /// read. The columns must outlive the writer.
  ColumnWriter(const GroundColumns& columns, std::size_t column, ColumnChanges& out)
      : runs_(columns.column(column)), column_(column), first_(out.size()), out_(out) {}

  /// Returns the material before the brush. Requires a height inside the box. Cost: O(log runs).
  Material old(std::int32_t y) const { return material_in_column(runs_, y); }
  /// Appends a voxel, unless it has this material already. Requires a height above those before.
  void set(std::int32_t y, Material material) {
    if (old(y) == material) return;
    if (out_.size() > first_ && out_.back().high == y && out_.back().material == material) {
      ++out_.back().high;
    } else {
      out_.push_back({column_, y, y + 1, material});
    }
  }

 private:
  const std::span<const ColumnRun> runs_;
  const std::size_t column_;
  const std::size_t first_;
  ColumnChanges& out_;
};

/// The voxel on the ground of a column.
struct Standing {
  Material above = kEmpty;
  bool is_plant = false;   // it is one voxel high, and neither ground nor liquid
  Material rest = kEmpty;  // fills what becomes free below it: a liquid, or nothing
};

/// Returns what stands on a surface. Requires that the box has two voxels above it.
inline Standing standing_on(const ColumnWriter& column, std::int32_t surface,
                            const GroundMaterials& materials) {
  Standing out;
  out.above = column.old(surface + 1);
  out.is_plant = !materials.is_open(out.above) && !materials.is_ground(out.above) &&
                 materials.is_open(column.old(surface + 2));
  if (materials.is_liquid(out.above)) out.rest = out.above;
  return out;
}

}  // namespace runstone
