// PanelWindows: the windows of the interface that are used beside playing: tools, timeline, map,
// rollback and the library of builds. The desktop client and the browser client have them in
// common. One thread.
#pragma once
#include <array>
#include <vector>

#include "client/input/input_router.hpp"
#include "client/ui/hud_state.hpp"
#include "client/ui/library_window.hpp"
#include "client/ui/map_window.hpp"
#include "client/ui/rollback_window.hpp"
#include "client/ui/timeline_window.hpp"
#include "client/ui/tool_window.hpp"
#include "client/ui/ui_action.hpp"
#include "client/ui/ui_context.hpp"

namespace runstone {

class PanelWindows {
 public:
  /// `keys` must outlive the windows.
  explicit PanelWindows(const KeyMap& keys) : tools_(keys) {}

  /// Opens or closes the window of an action. Returns false if the action has none.
  bool act(Action action);
  /// Closes one window. Returns false if none is open.
  bool close_one();
  bool is_any_open() const;
  /// Returns true if a window is open that has text fields.
  bool has_fields() const;
  /// Returns the number of open windows that need the mouse.
  unsigned count_with_mouse() const;

  TimelineWindow& timeline() { return timeline_; }
  const TimelineWindow& timeline() const { return timeline_; }
  MapWindow& map() { return map_; }
  const MapWindow& map() const { return map_; }
  const RollbackWindow& rollback() const { return rollback_; }
  LibraryWindow& library() { return library_; }
  const LibraryWindow& library() const { return library_; }
  ToolWindow& tools() { return tools_; }
  const ToolWindow& tools() const { return tools_; }

  /// Returns true if a window was opened or closed since the last call, so that ImGui does not know
  /// its height.
  bool take_changed();
  /// Makes the open windows with ImGui, and appends what the user did in them.
  void build(const HudState& state, UiContext& context, std::vector<UiAction>& out);

 private:
  TimelineWindow timeline_;
  ToolWindow tools_;
  MapWindow map_;
  RollbackWindow rollback_;
  LibraryWindow library_;
  std::array<bool, 4> open_{};  // which of them were open in the last call of take_changed()
};

}  // namespace runstone
