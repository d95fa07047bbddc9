#include "client/input/input_router.hpp"

#include <algorithm>
#include <utility>

#include "client/input/gamepad.hpp"

namespace runstone {
namespace {

bool is_modifier(Key key) { return key >= Key::left_shift && key <= Key::right_alt; }
bool is_function_key(Key key) { return key >= Key::f1 && key <= Key::f12; }

/// Returns true for a press of a button if the cursor has moved over the interface in this turn.
/// Then only the next turn knows over which window the cursor is.
bool is_press_after_move(const InputEvent& event, const RoutedInput& out) {
  const auto* const button = std::get_if<ButtonEvent>(&event);
  return button != nullptr && button->is_pressed &&
         std::any_of(out.for_ui.begin(), out.for_ui.end(), [](const InputEvent& routed) {
           return std::holds_alternative<CursorEvent>(routed);
         });
}

bool may_end_text(const KeyEvent& event) {
  return event.is_pressed && (event.key == Key::enter || event.key == Key::keypad_enter);
}

}  // namespace

void InputRouter::push(const std::vector<InputEvent>& events) {
  events_.insert(events_.end(), events.begin(), events.end());
}

RoutedInput InputRouter::route(const UiFocus& focus) {
  RoutedInput out;
  bool is_freed = false;
  while (!events_.empty() && out.player.actions.empty() && !is_freed) {
    if (is_press_after_move(events_.front(), out)) break;
    const InputEvent event = events_.front();
    events_.pop_front();
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
      const bool was_captured = is_captured_;
      if (takes_key(*key, focus, out)) {
        is_freed = was_captured && !is_captured_;
        // The interface knows which of these keys are held, for a click with control.
        if (!is_captured_ && is_modifier(key->key)) out.for_ui.push_back(event);
        // The character of this key belongs to no text.
        while (!events_.empty() && std::holds_alternative<CharacterEvent>(events_.front()))
          events_.pop_front();
      } else if (!is_captured_ || !key->is_pressed) {
        // The interface sees every release, also of a key that closed its window.
        out.for_ui.push_back(event);
        if (focus.types && may_end_text(*key)) break;
      }
    } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
      take_button(*button, focus, out);
    } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
      take_cursor(*cursor, out);
    } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
      take_wheel(*wheel, out);
    } else if (const auto* pad = std::get_if<GamepadButtonEvent>(&event)) {
      take_gamepad(*pad, focus, out);
    } else if (const auto* sticks = std::get_if<StickEvent>(&event)) {
      sticks_ = *sticks;
    } else if (std::holds_alternative<FocusEvent>(event)) {
      release_all();
    } else if (!is_captured_) {
      out.for_ui.push_back(event);
    }
  }
  add_held(out.player);
  return out;
}

std::vector<InputEvent> InputRouter::take_waiting() {
  std::vector<InputEvent> out(events_.begin(), events_.end());
  events_.clear();
  return out;
}

bool InputRouter::takes_key(const KeyEvent& event, const UiFocus& focus, RoutedInput& out) {
  const auto held = keys_.held(event.place);
  if (!event.is_pressed) {
    if (held) held_[static_cast<std::size_t>(*held)] = false;
    return false;
  }
  const auto action = keys_.pressed(event);
  const bool is_release = action == Action::release;
  if (focus.types && !is_function_key(event.key) && !is_release) return false;
  const bool is_scroll = event.key == Key::up || event.key == Key::down;
  if (is_scroll && focus.scrolls && !is_captured_) return false;
  if (held) held_[static_cast<std::size_t>(*held)] = true;
  if (!action || event.is_repeat) return held.has_value();
  if (is_release && is_captured_) {
    is_captured_ = false;
    remove_held_ = place_held_ = false;
    return true;
  }
  out.player.actions.push_back(*action);
  return true;
}

void InputRouter::take_button(const ButtonEvent& event, const UiFocus& focus, RoutedInput& out) {
  if (!is_captured_ || !event.is_pressed) out.for_ui.emplace_back(event);
  bool* const held = event.button == MouseButton::left    ? &remove_held_
                     : event.button == MouseButton::right ? &place_held_
                                                          : nullptr;
  if (!event.is_pressed) {
    if (held != nullptr) *held = false;
    return;
  }
  if (!is_captured_) {
    is_captured_ = !focus.has_window && !focus.over_window && !has_window_;
    return;
  }
  if (held != nullptr) *held = true;
  if (event.button == MouseButton::left) ++out.player.remove_clicks;
  if (event.button == MouseButton::right) ++out.player.place_clicks;
  if (event.button == MouseButton::middle) ++out.player.pick_clicks;
}

void InputRouter::take_cursor(const CursorEvent& event, RoutedInput& out) const {
  if (!is_captured_) return out.for_ui.push_back(event);
  out.player.look_dx += event.dx;
  out.player.look_dy += event.dy;
}

void InputRouter::take_wheel(const WheelEvent& event, RoutedInput& out) const {
  if (!is_captured_) return out.for_ui.push_back(event);
  out.player.scroll += event.steps > 0 ? 1 : event.steps < 0 ? -1 : 0;
}

void InputRouter::take_gamepad(const GamepadButtonEvent& event, const UiFocus& focus,
                               RoutedInput& out) {
  const bool is_free = !focus.has_window || event.button == GamepadButton::start;
  if (event.is_pressed && !is_free) return;
  pad_held_[static_cast<std::size_t>(event.button)] = event.is_pressed;
  if (!event.is_pressed) return;
  switch (event.button) {
    case GamepadButton::right_trigger:
      ++out.player.remove_clicks;
      return;
    case GamepadButton::left_trigger:
      ++out.player.place_clicks;
      return;
    case GamepadButton::right_stick:
      ++out.player.pick_clicks;
      return;
    case GamepadButton::left_bumper:
      ++out.player.scroll;
      return;
    case GamepadButton::right_bumper:
      --out.player.scroll;
      return;
    default:
      break;
  }
  for (const GamepadBinding& binding : gamepad_table()) {
    if (binding.button == event.button && binding.action && !info_of(*binding.action).is_held)
      out.player.actions.push_back(*binding.action);
  }
}

void InputRouter::release() {
  is_captured_ = false;
  release_all();
}

void InputRouter::release_all() {
  held_.fill(false);
  pad_held_.fill(false);
  sticks_ = {};
  remove_held_ = place_held_ = false;
}

void InputRouter::set_windows(bool has_window, unsigned panels) {
  const bool had_window = std::exchange(has_window_, has_window);
  const unsigned had_panels = std::exchange(panels_, panels);
  if (had_window == has_window && had_panels == panels) return;
  release_all();
  if (had_panels != 0 && panels == 0) {
    bool& captures = has_window ? captures_after_window_ : is_captured_;
    captures = captures || captures_after_panel_;
  }
  if (had_window && !has_window) is_captured_ = is_captured_ || captures_after_window_;
  if (panels > had_panels) {
    const bool was_captured = std::exchange(is_captured_, false);
    captures_after_panel_ = was_captured || (had_panels != 0 && captures_after_panel_);
  }
  if (!had_window && has_window) captures_after_window_ = std::exchange(is_captured_, false);
}

void InputRouter::add_held(WindowInput& input) const {
  // A stick that is so far from its middle counts as a key.
  constexpr double kHeld = 0.1;
  const auto is_pad_held = [this](GamepadButton button) {
    return pad_held_[static_cast<std::size_t>(button)];
  };
  input.forward = is_held(Action::move_forward) || sticks_.move_y < -kHeld;
  input.back = is_held(Action::move_back) || sticks_.move_y > kHeld;
  input.left = is_held(Action::move_left) || sticks_.move_x < -kHeld;
  input.right = is_held(Action::move_right) || sticks_.move_x > kHeld;
  input.up = is_held(Action::move_up) || is_pad_held(GamepadButton::a);
  input.down = is_held(Action::move_down) || is_pad_held(GamepadButton::b);
  input.fast = is_held(Action::move_fast) || is_pad_held(GamepadButton::left_stick);
  input.shows_players = is_held(Action::show_players);
  input.resizes = is_held(Action::resize);
  input.remove_held = remove_held_ || is_pad_held(GamepadButton::right_trigger);
  input.place_held = place_held_ || is_pad_held(GamepadButton::left_trigger);
  input.turn_x = sticks_.look_x;
  input.turn_y = sticks_.look_y;
}

}  // namespace runstone
