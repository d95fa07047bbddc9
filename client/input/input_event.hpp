// InputEvent: one event of keyboard, mouse or window. A window makes them, and so do scripts and
// tests.
#pragma once
#include <cstddef>
#include <cstdint>
#include <variant>

#include "client/input/key.hpp"

namespace runstone {

/// A key was pressed, released, or repeated by the system while it is held.
struct KeyEvent {
  Key place = Key::unknown;  // by its place on an American keyboard
  Key key = Key::unknown;    // by the letter on it in the user's layout; otherwise as `place`
  bool is_pressed = false;
  bool is_repeat = false;
  bool control = false, shift = false, alt = false;  // modifiers that are held
};
/// A character was typed.
struct CharacterEvent {
  char32_t character = 0;
};
/// The mouse moved. While it is captured only the movement counts.
struct CursorEvent {
  double x = 0, y = 0;    // pixels of the frame, from its upper left corner
  double dx = 0, dy = 0;  // since the last event, y downward; units of the window system
};
enum class MouseButton : std::uint8_t { left, right, middle };
struct ButtonEvent {
  MouseButton button = MouseButton::left;
  bool is_pressed = false;
};
struct WheelEvent {
  double steps = 0;  // up positive
};
/// The window got the focus of the keyboard, or lost it.
struct FocusEvent {
  bool has_focus = false;
};

/// The buttons of a gamepad, in GLFW's order, and the two triggers as buttons.
enum class GamepadButton : std::uint8_t {
  a,
  b,
  x,
  y,
  left_bumper,
  right_bumper,
  back,
  start,
  guide,
  left_stick,
  right_stick,
  up,
  right,
  down,
  left,
  left_trigger,
  right_trigger,
};
inline constexpr std::size_t kGamepadButtonCount =
    static_cast<std::size_t>(GamepadButton::right_trigger) + 1;
struct GamepadButtonEvent {
  GamepadButton button = GamepadButton::a;
  bool is_pressed = false;
};
/// The sticks of a gamepad moved. Each is -1 to 1, to the right and downward.
struct StickEvent {
  double move_x = 0, move_y = 0, look_x = 0, look_y = 0;
  friend bool operator==(const StickEvent&, const StickEvent&) = default;
};

using InputEvent = std::variant<KeyEvent, CharacterEvent, CursorEvent, ButtonEvent, WheelEvent,
                                FocusEvent, GamepadButtonEvent, StickEvent>;

}  // namespace runstone
