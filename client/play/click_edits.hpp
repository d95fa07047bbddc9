// ClickEdits: passes the buttons of the mouse to the tool of the player. One thread.
#pragma once
#include <string>
#include <vector>

#include "client/input/window_input.hpp"
#include "client/play/edit_tool.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// A mouse button that acts when it is pressed, and again and again while it is held.
class HeldButton {
 public:
  static constexpr TimeUs kDelayUs = 400'000;   // from the press to the first repetition
  static constexpr TimeUs kRepeatUs = 150'000;  // between two repetitions

  /// Returns how often the button acts now: once for each press since the last call, or once if a
  /// repetition is due. Repetitions that a late call missed are skipped. A press that does not
  /// count, such as the one that captures the mouse, begins no repetition.
  int acts(int presses, bool is_held, TimeUs now_us) {
    if (presses > 0) {
      is_repeating_ = true;
      next_us_ = now_us + kDelayUs;
      return presses;
    }
    is_repeating_ = is_repeating_ && is_held;
    if (!is_repeating_ || now_us < next_us_) return 0;
    next_us_ = now_us + kRepeatUs;
    return 1;
  }

 private:
  bool is_repeating_ = false;  // held since a press that counted
  TimeUs next_us_ = 0;
};

class ClickEdits {
 public:
  /// `tool` must outlive the object.
  explicit ClickEdits(EditTool& tool) : tool_(tool) {}

  /// Carries out presses of the left and the right button. `releases`: a button that is not held
  /// counts as released, so a tool that waits for the release acts. While the player holds the key
  /// that moves fast, a chosen box is added to the selection; with the key that resizes it is removed
  /// from the selection. Returns for each refused edit the reason, in words for the player.
  std::vector<std::string> step(const WindowInput& input, bool releases, TimeUs now_us);

 private:
  EditTool& tool_;
  HeldButton remove_button_, place_button_;
};

}  // namespace runstone
