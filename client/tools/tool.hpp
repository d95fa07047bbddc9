// Tool: turns places that the player chooses into edits. A tool has parameters and no other state;
// ToolBox keeps the places chosen so far. Pure: no clock, socket, window or OpenGL. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/replica/replica.hpp"
#include "client/tools/aim.hpp"
#include "client/tools/tool_action.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/brush_stroke.hpp"

namespace runstone {

/// A number of a tool that the player sets. A window or a script shows and sets all parameters in
/// the same way.
struct ToolParameter {
  std::string name;  // one word, lower case
  std::string unit;  // "voxels", or empty
  std::int32_t low = 0, high = 0;
  std::int32_t value = 0;
  /// The names of the values low .. high. Empty if the parameter is a plain number.
  std::vector<std::string> choices;
};

/// The bytes of a text of a tool, at most.
inline constexpr std::size_t kToolTextBytesMax = 1024;

/// A text of a tool that the player types. A window or a script shows and sets all texts in the same
/// way. Those of all kinds but `plain` are in the language of patterns (common/patterns).
struct ToolText {
  enum class Kind : std::uint8_t { plain, pattern, mix, filter };
  std::string name;  // one word, lower case
  std::string hint;  // shown while the text is empty
  Kind kind = Kind::pattern;
  std::string text = {};                // UTF-8 without control characters; empty: not given
  std::string error = {};               // the mistake in a pattern, or empty
  std::vector<std::string> chips = {};  // the parts of a pattern, as the tool understands them
};

/// The content of a paste, as it lies in the world: turns and mirrors make another build.
struct ToolClipboard {
  BuildPtr build;  // null: nothing was copied
  EmptyCells empty = EmptyCells::pasted;
  /// The build as the clipboard of one descriptor, or null if it is too large for one.
  std::shared_ptr<const Clipboard> whole;
};

/// The facts from which a tool makes its edits.
struct ToolInput {
  const Replica& replica;  // open
  const Aim& aim;
  ToolButton button = ToolButton::place;
  std::span<const VoxelPos> points;  // chosen before
  VoxelPos target;                   // the voxel that this click chooses
  /// Boxes that do not overlap; none: nothing is selected.
  std::span<const VoxelBox> selection;
  VoxelRowsPtr selected;  // the selected voxels of `selection`; null: all
  const ToolClipboard& clipboard;
  const MaterialTable& materials;
  bool has_copies = false;  // the symmetry makes copies of the edits
};

class Tool {
 public:
  Tool(std::string_view name, std::string_view what, std::vector<ToolParameter> parameters,
       std::vector<ToolText> texts = {})
      : name_(name), what_(what), parameters_(std::move(parameters)), texts_(std::move(texts)) {}
  virtual ~Tool() = default;
  Tool(const Tool&) = delete;
  Tool& operator=(const Tool&) = delete;

  std::string_view name() const { return name_; }
  /// Returns what the tool does, in one line for the player.
  std::string_view what() const { return what_; }
  std::span<const ToolParameter> parameters() const { return parameters_; }
  /// Sets a parameter by its name. Fails with words for the player if there is no such parameter or
  /// the value is out of its range.
  Result<void, std::string> set(std::string_view parameter, std::int32_t value);
  std::span<const ToolText> texts() const { return texts_; }
  /// Sets a text by its name. A pattern with a mistake is kept with its error, and plan() fails.
  /// Fails with words for the player if there is no such text, or if it is longer than
  /// kToolTextBytesMax or not in UTF-8 without control characters.
  Result<void, std::string> set_text(std::string_view name, std::string text);

  /// Returns the number of places that are chosen before a click completes an action, at least and
  /// at most.
  virtual std::size_t points_before() const { return 0; }
  virtual std::size_t points_before_max() const { return points_before(); }
  /// Returns true if a click on `target` completes an action after these places.
  virtual bool completes(std::span<const VoxelPos> points, VoxelPos /*target*/) const {
    return points.size() >= points_before_max();
  }
  /// Returns true if the places are collected while the button is held, and its release completes
  /// the action.
  virtual bool is_drawn() const { return false; }
  /// Returns true if both buttons choose the voxel that the player looks at. Otherwise
  /// ToolButton::place chooses the empty place in front of it.
  virtual bool chooses_solid() const { return false; }
  /// Returns true if a place after the first one may be in the air although chooses_solid(), and if
  /// all places that are typed may.
  virtual bool reaches_air() const { return selects(); }
  /// Returns true if the chosen places become the selection, and no edit is made.
  virtual bool selects() const { return false; }
  /// Returns what the chosen places do with the selection, if selects().
  virtual SelectMode select_mode() const { return SelectMode::fresh; }
  /// Returns true if the first two places are opposite corners of the box that the tool works on.
  virtual bool spans_box() const { return false; }
  /// Returns what the place with this number, from 0, is called for the player.
  virtual std::string_view place_name(std::size_t) const { return "voxel"; }
  /// Returns true if plan() may take longer than a frame with the present parameters. A preview
  /// then waits until the aim rests.
  virtual bool is_costly() const { return false; }
  /// Returns what the click makes that completes an action. Fails with words for the player. The
  /// edits are valid, but the world's limits are not checked.
  virtual Result<ToolAction, std::string> plan(const ToolInput& input) const = 0;
  /// Returns the settings of a brush and the places of its stroke, from which plan() works out its
  /// edits, or nullopt if the tool is no such brush. `points` are as in ToolInput, and the last
  /// place is `target`.
  virtual std::optional<BrushStroke> stroke(Material /*held*/, ToolButton /*button*/,
                                            std::span<const VoxelPos> /*points*/,
                                            VoxelPos /*target*/) const {
    return std::nullopt;
  }
  /// Frees what plan() has kept for the next plan. It changes no result.
  virtual void forget_plan() {}

 protected:
  /// Returns the value of a parameter. Requires a parameter of this tool.
  std::int32_t value(std::string_view parameter) const;
  /// Returns a text. Requires a text of this tool.
  const ToolText& text(std::string_view name) const;
  /// Returns the mask that the parameter of mask_parameter() chooses.
  Mask mask() const;
  static ToolParameter mask_parameter();
  /// Returns the material that a button sets: the held one, or none.
  static Material material_of(const ToolInput& input) {
    return input.button == ToolButton::place ? input.aim.held : kEmpty;
  }

 private:
  const std::string_view name_, what_;
  std::vector<ToolParameter> parameters_;
  std::vector<ToolText> texts_;
};

using ToolEdits = Result<ToolAction, std::string>;

}  // namespace runstone
