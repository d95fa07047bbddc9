// Gamepad: turns what a gamepad reports into input events, and says what its buttons do. A window
// reads the gamepad, and tests make samples. One thread.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "client/input/action.hpp"
#include "client/input/input_event.hpp"

namespace runstone {

/// The state of a gamepad at one moment, in GLFW's order (the layout of an Xbox gamepad).
struct GamepadSample {
  std::array<bool, 15> buttons{};  // as GamepadButton::a .. GamepadButton::left
  /// Left stick x, y, right stick x, y (-1 to 1, y downward), left and right trigger (-1 released,
  /// 1 pressed).
  std::array<float, 6> axes{0, 0, 0, 0, -1, -1};
};

class GamepadReader {
 public:
  /// A stick that is nearer to its middle than this share of its range counts as released.
  static constexpr double kDeadZone = 0.2;

  /// Appends the events by which the sample differs from the last one. nullopt is a gamepad that is
  /// not there: everything is released.
  void read(const std::optional<GamepadSample>& sample, std::vector<InputEvent>& out);

 private:
  GamepadSample last_;
  StickEvent sticks_;
};

/// A button and what it does.
struct GamepadBinding {
  GamepadButton button{};
  std::string_view name;         // for people
  std::optional<Action> action;  // nullopt: `what` says what it does
  std::string_view what;
};
/// Returns the buttons that do something, in the order of the table in docs/client.md.
std::span<const GamepadBinding> gamepad_table();

}  // namespace runstone
