// PastedBuild: a build that was just pasted, and the voxels that it replaced, so that it may be moved
// by single voxels. A voxel that somebody has changed since stays as it is. One thread.
#pragma once
#include <cstdint>
#include <map>
#include <optional>

#include "client/replica/replica.hpp"
#include "client/tools/tool.hpp"
#include "client/tools/tool_action.hpp"
#include "common/builds/build.hpp"
#include "common/core/coords.hpp"

namespace runstone {

class PastedBuild {
 public:
  /// The cells of a build that may be moved, touched or not.
  static constexpr std::uint64_t kVolumeMax = std::uint64_t{1} << 18;

  /// Returns the clipboard where the paste tool puts it with `made`. Returns nullopt if `made` has
  /// mirrored copies, if the clipboard is larger than kVolumeMax, or if not all voxels there are shown.
  /// Call it before the edits are applied. Requires an open replica. Cost: O(volume * log cells).
  static std::optional<PastedBuild> of(const ToolAction& made, const ToolClipboard& clipboard,
                                       const Replica& replica);

  /// Returns the edit that moves the build by one voxel, which may be none, and counts it as moved.
  /// The edit restores voxels that still have the material of the build. Fails with words for the
  /// player. Cost: as of().
  ToolEdits move(Direction direction, const Replica& replica);

 private:
  PastedBuild() = default;
  /// Calls f(cell, material) for each cell that a paste sets.
  template <class F>
  void for_each_cell(F&& f) const;

  BuildPtr build_;
  VoxelPos at_;
  Mask mask_;
  EmptyCells empty_ = EmptyCells::pasted;
  std::map<VoxelPos, Material> before_;  // the voxels that the build set, as they were before
};

}  // namespace runstone
