// PastedBuild: a build that was just pasted, and the voxels that it replaced, so that it may be moved
// by single voxels. A voxel that somebody has changed since stays as it is. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/replica/replica.hpp"
#include "client/tools/tool.hpp"
#include "client/tools/tool_action.hpp"
#include "common/core/coords.hpp"

namespace runstone {

class PastedBuild {
 public:
  /// The cells of a build that may be moved, touched or not.
  static constexpr std::uint64_t kVolumeMax = std::uint64_t{1} << 18;

  /// Returns the clipboard where the paste tool puts it with `made`. Returns nullopt if `made` has
  /// mirrored copies, if the clipboard is larger than kVolumeMax, or if not all voxels there are shown.
  /// Call it before the edits are applied. Requires an open replica. Cost: O(volume * log runs).
  static std::optional<PastedBuild> of(const ToolAction& made, const ToolClipboard& clipboard,
                                       const Replica& replica);

  /// Returns the edit that moves the build by one voxel, which may be none, and counts it as moved.
  /// The edit restores voxels that still have the material of the build. Fails with words for the
  /// player. Cost: O(volume * log runs), and that of paste_of() for the voxels that change.
  ToolEdits move(Direction direction, const Replica& replica);

 private:
  PastedBuild() = default;
  /// A material, or kNone.
  using Slot = std::int32_t;
  static constexpr Slot kNone = -1;
  /// Calls f(cell, number) for each cell of the build, in the order of their numbers.
  template <class F>
  void for_each_cell(F&& f) const;
  /// Returns the number of a cell, or nullopt if it is outside of the build.
  std::optional<std::size_t> number_of(VoxelPos cell) const;

  VoxelPos sides_;
  VoxelPos at_;
  Mask mask_;
  // By the numbers of the cells.
  std::vector<Slot> cells_;   // the materials that a paste sets
  std::vector<Slot> before_;  // the voxels that the build set, as they were before
};

}  // namespace runstone
