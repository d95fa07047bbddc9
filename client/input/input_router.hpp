// InputRouter: decides who gets each event of keyboard and mouse.
//   - While the mouse is captured, the player gets it, and the user interface gets nothing.
//   - While the mouse is free, the user interface gets it. A click beside its windows captures the
//     mouse, unless a window waits for an answer. A window that is used beside playing, such as the
//     map, frees the mouse when it opens.
//   - The gamepad is the player's, also while the mouse is free. While a window needs the mouse, of
//     its buttons only `start` acts.
//   - While a text is typed, the user interface gets the keys. Only function keys and escape act.
//   - While a window scrolls by arrows and the mouse is free, the user interface gets these arrows.
// One thread.
#pragma once
#include <array>
#include <deque>
#include <vector>

#include "client/input/input_event.hpp"
#include "client/input/key_map.hpp"
#include "client/input/window_input.hpp"

namespace runstone {

/// Which of the next events the user interface takes for itself.
struct UiFocus {
  bool types = false;        // a text field has the keyboard
  bool has_window = false;   // a window is open that needs the mouse, such as the palette
  bool over_window = false;  // the cursor is over some window
  unsigned panels = 0;       // open windows that are used beside playing, such as the map
  bool scrolls = false;      // a window scrolls by the arrows up and down while the mouse is free
};

struct RoutedInput {
  WindowInput player;
  std::vector<InputEvent> for_ui;
};

class InputRouter {
 public:
  void set_keys(const KeyMap& keys) { keys_ = keys; }
  const KeyMap& keys() const { return keys_; }

  /// Queues events. They are routed in order.
  void push(const std::vector<InputEvent>& events);
  /// Routes queued events up to the first one after which `focus` may be another one: a key that
  /// triggers an action, frees the mouse or ends a text, or a movement before a click. Call it
  /// every turn.
  RoutedInput route(const UiFocus& focus);
  /// Returns the events that wait for the next route(), and forgets them.
  std::vector<InputEvent> take_waiting();

  /// Returns true if events wait for the next route().
  bool has_events() const { return !events_.empty(); }
  bool is_captured() const { return is_captured_; }
  /// Captures the mouse, as a click beside all windows does.
  void capture() { is_captured_ = true; }
  /// Frees the mouse, and forgets what is held down.
  void release();
  /// Forgets which keys and buttons are held down. Call it while other code takes the events.
  void release_all();
  /// Frees the mouse while a window needs it, and when one more panel opens. When all of them are
  /// closed, the mouse is captured again if it was captured before.
  void set_windows(bool has_window, unsigned panels);

 private:
  bool takes_key(const KeyEvent& event, const UiFocus& focus, RoutedInput& out);
  void take_button(const ButtonEvent& event, const UiFocus& focus, RoutedInput& out);
  void take_gamepad(const GamepadButtonEvent& event, const UiFocus& focus, RoutedInput& out);
  void take_cursor(const CursorEvent& event, RoutedInput& out) const;
  void take_wheel(const WheelEvent& event, RoutedInput& out) const;
  void add_held(WindowInput& input) const;
  bool is_held(Action action) const { return held_[static_cast<std::size_t>(action)]; }

  KeyMap keys_;
  std::deque<InputEvent> events_;
  std::array<bool, kActionCount> held_{};
  bool remove_held_ = false, place_held_ = false;
  std::array<bool, kGamepadButtonCount> pad_held_{};
  StickEvent sticks_;
  bool is_captured_ = false;
  bool has_window_ = false;
  unsigned panels_ = 0;
  // True: the mouse is captured again when they close.
  bool captures_after_window_ = false, captures_after_panel_ = false;
};

}  // namespace runstone
