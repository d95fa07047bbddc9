// HeldButton: a mouse button that acts when it is pressed, and again and again while it is held.
#pragma once
#include "common/core/ids.hpp"

namespace runstone {

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

}  // namespace runstone
