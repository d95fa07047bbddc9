// Selected voxels: a selection that is no set of few boxes, such as all voxels of one material or
// the voxels that the wand has found, and the commands of the selection on it. Thread: one.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "client/replica/replica.hpp"
#include "client/tools/box_set.hpp"
#include "client/tools/tool.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/sculpt/voxel_rows.hpp"

namespace runstone {

/// The selected voxels.
struct Selected {
  BoxSet boxes;         // with `voxels`, the box around them
  VoxelRowsPtr voxels;  // never empty; null: the voxels of the boxes are selected
  /// The number of `voxels`, which is counted once because windows show it in each frame.
  std::uint64_t voxel_count = 0;

  /// Returns the voxels as a selection; an empty set selects nothing.
  static Selected of(VoxelRows rows);
  bool empty() const { return boxes.empty(); }
  /// Compares sets of voxels by address: two sets are equal if they are one object.
  friend bool operator==(const Selected&, const Selected&) = default;
};

/// The greatest number of voxels of a selection that is no set of boxes. A selection of boxes may
/// have any number.
inline constexpr std::uint64_t kSelectedVoxelsMax = 4'000'000;

/// Returns the selected voxels as rows. Fails with words for the player if there are too many.
Result<VoxelRows, std::string> rows_of(const Selected& selected);

/// Returns the selection after voxels replaced it, were added to it or were removed from it. Fails
/// with words for the player if the result has more than kSelectedVoxelsMax voxels. Cost:
/// O(stretches).
Result<Selected, std::string> combined(const Selected& now, VoxelRows rows, SelectMode mode);

/// Returns the selected voxels for which a typed filter holds, or does not hold if `is_kept` is
/// false. Fails with words for the player. Requires an open replica. Cost: as passing_voxels() for
/// the boxes.
Result<Selected, std::string> filtered(const Replica& replica, const Selected& now,
                                       const std::string& filter, bool is_kept,
                                       const MaterialTable& materials);

/// Returns the voxels moved outward at one side by some steps, or inward by a negative number.
/// Fails with words for the player if too many voxels, or none, would be selected.
Result<Selected, std::string> grown_selection(const Selected& now, Direction side,
                                              std::int32_t steps);

/// Returns the edits that give the voxels a material, or only those of the material `from`. They
/// contain the voxels that change and no others. Fails with words for the player. Requires an open
/// replica. Cost: that of build_of_voxels().
ToolEdits refilled(const Replica& replica, const VoxelRows& rows, std::optional<Material> from,
                   Material to);

/// Returns the edits that move the voxels. Solid voxels move and leave empty ones behind. Fails
/// with words for the player. Requires an open replica. Cost: that of build_of_voxels().
ToolEdits moved_voxels(const Replica& replica, const VoxelRows& rows, Direction direction,
                       std::int32_t steps);

}  // namespace runstone
