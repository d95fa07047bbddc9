// TimelineWindow: a slider over the log of the world. Moving it shows the world as it was. Below it
// are the authors of the log and the last edits before the shown moment; a click shows the world
// after that edit. One thread.
#pragma once
#include <optional>
#include <utility>

#include "client/ui/hud_state.hpp"
#include "client/ui/ui_action.hpp"

namespace runstone {

class TimelineWindow {
 public:
  void toggle() { is_open_ = !is_open_; }
  void set_open(bool is_open) { is_open_ = is_open; }
  bool close() { return std::exchange(is_open_, false); }
  bool is_open() const { return is_open_; }
  /// Makes the window with ImGui. Returns the moment if the user moved to another one. While the
  /// slider is dragged, a moment is returned only after the one before was loaded.
  std::optional<ShowMoment> build(const TimelineState& state, double scale);

 private:
  /// Makes the list of the last edits. Returns the one that the user clicked.
  static std::optional<Sequence> build_recent(const TimelineState& state);

  bool is_open_ = false;
  std::optional<double> dragged_;      // the edit at the slider, until its moment is requested
  std::optional<Sequence> requested_;  // the last one that was requested while dragging
};

}  // namespace runstone
