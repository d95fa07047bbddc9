// ToolWindow: the building tools with their numbers, the effect of the next click, places by
// numbers, the symmetry, the selection and the clipboard, and the time of day. It changes nothing
// itself: it returns commands. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/input/key_map.hpp"
#include "client/tools/tool_command.hpp"
#include "client/ui/file_panel.hpp"
#include "client/ui/hud_state.hpp"
#include "client/ui/time_panel.hpp"

namespace runstone {

class ToolWindow {
 public:
  /// `keys` must outlive the window.
  explicit ToolWindow(const KeyMap& keys) : keys_(keys) {}

  /// Opens the window, or closes it. An open window without the mouse takes it first.
  void toggle();
  /// Closes the window. Returns false if it was closed.
  bool close();
  bool is_open() const { return is_open_; }
  /// Returns true if the window needs the mouse: from its opening until a click beside it captures
  /// the mouse.
  bool has_mouse() const { return is_open_ && has_mouse_; }

  /// Makes the window with ImGui, and appends what the user did in it. Requires HudState::tools if
  /// the window is open.
  void build(const HudState& state, double scale, std::vector<ToolCommand>& out);
  /// The file that the user wants to read or to write. The commands of build() come first.
  FilePanel& file() { return file_; }
  /// Returns the time of day that the user chose since the last call, or nullopt if there is none.
  std::optional<SetTime> take_time() { return std::exchange(time_, std::nullopt); }

 private:
  void build_tools(const ToolBox& box, std::vector<ToolCommand>& out) const;
  void build_places(const HudState& state, std::vector<ToolCommand>& out);
  void build_symmetry(const HudState& state, std::vector<ToolCommand>& out);
  void build_selection(const HudState& state, double scale, std::vector<ToolCommand>& out);
  void build_steps(std::vector<ToolCommand>& out);
  void build_narrow(std::vector<ToolCommand>& out);
  void build_clipboard(const ToolBox& box, std::vector<ToolCommand>& out);
  void build_reshape(std::vector<ToolCommand>& out);
  TypedPlaces typed_places() const;

  using Numbers = std::array<int, 3>;  // x, y, z

  const KeyMap& keys_;
  bool is_open_ = false, has_mouse_ = false;
  bool was_captured_ = false;    // the mouse, in the last frame
  bool types_places_ = false;    // the places of the window count
  std::vector<Numbers> places_;  // of the chosen tool
  bool clears_ = false;
  int face_ = 3, direction_ = 3;  // of Direction; 3 is upward
  int count_ = 1;
  bool keeps_air_ = false;
  int turn_axis_ = 1, turn_degrees_ = 45, turn_percent_ = 100;  // of the clipboard
  std::string replaced_;  // the name of the material to be replaced, as typed
  std::string narrowed_;  // the filter of the selected voxels, as typed
  FilePanel file_;
  std::optional<SetTime> time_;
};

}  // namespace runstone
