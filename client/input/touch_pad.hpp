// TouchPad: makes the input of a player from the touches of a screen.
//   - A touch that begins in the lower left part of the screen is a stick, by which the player
//     moves. Its middle is where the touch began.
//   - Any other touch turns the player while it moves. A short one that does not move is a click in
//     the middle of the screen. One that rests is a button that is held down.
// Pure: times are arguments. Thread: one.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "client/input/input_event.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// The edit that a tap makes.
enum class TapMode : std::uint8_t { place, remove };

class TouchPad {
 public:
  /// Sets the size of the screen. Lengths are those of the page (CSS pixels), about 0.26 mm.
  void set_size(double width, double height) { width_ = width, height_ = height; }
  void set_mode(TapMode mode) { mode_ = mode; }

  void begin(std::int64_t id, double x, double y, TimeUs now_us);
  void move(std::int64_t id, double x, double y);
  void end(std::int64_t id, TimeUs now_us);
  /// Ends all touches without a tap.
  void cancel();
  /// Call it for each frame: a touch that rests becomes a button that is held.
  void step(TimeUs now_us);
  /// Returns the events since the last call.
  std::vector<InputEvent> take_events();

  static constexpr double kStickShare = 0.4;  // of the width; of the height from below: 0.6
  static constexpr double kStickReach = 60;   // from the middle to the end of the stick
  static constexpr double kTapMoveMax = 12;   // a touch that moves farther is no tap
  static constexpr double kTurnPerPixel = 2;  // as movements of a mouse
  static constexpr TimeUs kHoldUs = 350'000;  // a touch that rests as long is held

 private:
  enum class Kind : std::uint8_t { stick, resting, turning, holding };
  struct Touch {
    Kind kind = Kind::resting;
    double first_x = 0, first_y = 0, x = 0, y = 0;
    TimeUs since_us = 0;
  };
  MouseButton button() const {
    return mode_ == TapMode::place ? MouseButton::right : MouseButton::left;
  }
  void set_stick(double x, double y);

  double width_ = 1, height_ = 1;
  TapMode mode_ = TapMode::place;
  std::map<std::int64_t, Touch> touches_;
  MouseButton held_ = MouseButton::right;  // by a touch of Kind::holding
  std::vector<InputEvent> events_;
};

}  // namespace runstone
