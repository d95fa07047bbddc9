// TimelineWindow: a slider over the log of the world. Moving it shows the world as it was, and a
// button plays the log. Below the slider are the authors of the log and the last edits before the
// shown moment. A click on an edit shows the world after it. One thread.
#pragma once
#include <cstddef>
#include <optional>
#include <utility>

#include "client/ui/hud_state.hpp"
#include "client/ui/timeline_play.hpp"
#include "client/ui/ui_action.hpp"

namespace runstone {

class TimelineWindow {
 public:
  void toggle() { is_open_ = !is_open_; }
  void set_open(bool is_open) { is_open_ = is_open; }
  bool close() { return std::exchange(is_open_, false); }
  bool is_open() const { return is_open_; }
  /// Opens the window. Then it plays the log from the shown moment on, or stops if the log is being
  /// played.
  void toggle_play() { is_open_ = is_play_toggled_ = true; }
  bool is_playing() const { return is_open_ && (play_.is_playing() || is_play_toggled_); }
  /// Makes the window with ImGui. Returns the moment if the user moved to another one. While the
  /// slider is dragged, a moment is returned only after the one before was loaded.
  std::optional<ShowMoment> build(const TimelineState& state, double scale);

 private:
  /// Makes the button that plays, and the choice of the speed. Returns true if it was pressed.
  bool build_play();
  /// Begins to play the log or stops it if `is_toggled`, and otherwise goes on. Returns the moment to
  /// show, or nullopt if it stays.
  std::optional<Sequence> play(const TimelineState& state, bool is_toggled);
  /// Makes the list of the last edits. Returns the one that the user clicked.
  static std::optional<Sequence> build_recent(const TimelineState& state);

  bool is_open_ = false;
  bool is_play_toggled_ = false;  // a key was pressed since the window was made
  TimelinePlay play_;
  std::size_t speed_ = 1;              // the place in the list of speeds
  std::optional<double> dragged_;      // the edit at the slider, until its moment is requested
  std::optional<Sequence> requested_;  // the last one that was requested while dragging
};

}  // namespace runstone
