// ToolAction: what a click or a command of the tools makes. All of it is one action. It is a value:
// a preview shows it, and source_of() (action_source.hpp) makes its edits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "client/tools/action_part.hpp"
#include "common/builds/build.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/sculpt/voxel_rows.hpp"

namespace runstone {

/// A paste of a build that is too large for one descriptor.
struct BuildPaste {
  BuildPtr build;
  VoxelPos at;  // of the corner of the build
  Mask mask;
  EmptyCells empty = EmptyCells::pasted;
  /// The touched cells are exactly the voxels that differ from the shown ones.
  bool is_difference = false;
  friend bool operator==(const BuildPaste&, const BuildPaste&) = default;

  VoxelBox box() const {
    const VoxelPos s = build->sides();
    return {at, {at.x + s.x, at.y + s.y, at.z + s.z}};
  }
};

struct PatternWork;

/// The effect of chosen voxels on the selection.
enum class SelectMode : std::uint8_t {
  fresh,   // they become the selection
  add,     // they are selected as well
  remove,  // they are not selected any more
};
inline constexpr std::int32_t kSelectModeCount = 3;

/// How the edits of a ToolAction belong to an action.
enum class ActionChain : std::uint8_t {
  closed,   // they are an action
  begins,   // they are an action to which later edits may be added
  goes_on,  // they belong to the action before
};

struct ToolAction {
  ToolAction() = default;
  ToolAction(std::vector<EditDescriptor> made) : edits(std::move(made)) {}

  /// The voxels that become the clipboard, and where they are in the world. No edit is made of them.
  std::optional<BuildPaste> copied;
  /// The voxels that the action selects. If it is set, `copied` only shows them.
  VoxelRowsPtr chosen;
  SelectMode chosen_mode = SelectMode::fresh;
  std::vector<BuildPaste> pastes;
  /// A pattern for a box that is too large to be worked out at once (pattern_work.hpp), or null.
  std::shared_ptr<const PatternWork> pattern;
  /// The edits after the pastes. Those that clear are the last ones. An edit may have more voxels and
  /// chunks than the world allows in one: then it is cut.
  std::vector<EditDescriptor> edits;
  /// A paste of air that is sent last, after all edits before it were applied.
  std::optional<BuildPaste> cleared;
  /// The edits after the first one only follow it, such as a fence that joins its neighbour: if one
  /// is refused, it is left out without a word.
  bool has_followers = false;
  ActionChain chain = ActionChain::closed;
  friend bool operator==(const ToolAction&, const ToolAction&) = default;

  bool empty() const { return pastes.empty() && !pattern && edits.empty() && !cleared; }
};

/// Returns the part of edit i of an action.
inline ActionPart part_of(const ToolAction& action, std::size_t i) {
  if (action.chain == ActionChain::goes_on) return ActionPart::next;
  if (action.chain == ActionChain::begins && i == 0) return ActionPart::first;
  return part_of_action(i, action.edits.size());
}

}  // namespace runstone
