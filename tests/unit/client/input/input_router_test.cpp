#include "client/input/input_router.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

using Actions = std::vector<Action>;

KeyEvent key(Key which, bool is_pressed, bool control = false) {
  KeyEvent event;
  event.place = event.key = which;
  event.is_pressed = is_pressed;
  event.control = control;
  return event;
}
ButtonEvent button(MouseButton which, bool is_pressed) { return {which, is_pressed}; }

constexpr UiFocus kTyping{true, true, false};

/// Routes events of one turn.
RoutedInput turn(InputRouter& router, const std::vector<InputEvent>& events,
                 const UiFocus& focus = {}) {
  router.push(events);
  return router.route(focus);
}

void capture(InputRouter& router) {
  turn(router, {button(MouseButton::left, true), button(MouseButton::left, false)});
  REQUIRE(router.is_captured());
}

}  // namespace

TEST_CASE("the first click captures the mouse and removes nothing", "[client_input]") {
  InputRouter router;
  const RoutedInput first = turn(router, {button(MouseButton::left, true)});
  CHECK(router.is_captured());
  CHECK(first.player.remove_clicks == 0);
  CHECK_FALSE(first.player.remove_held);
  turn(router, {button(MouseButton::left, false)});
  const RoutedInput second =
      turn(router, {button(MouseButton::left, true), CursorEvent{0, 0, 3, 4}});
  CHECK(second.player.remove_clicks == 1);
  CHECK(second.player.remove_held);
  CHECK(second.player.look_dx == 3);
  CHECK(second.for_ui.empty());
}

TEST_CASE("a click over a window or beside one that waits captures nothing", "[client_input]") {
  InputRouter router;
  const UiFocus over{false, false, true}, waits{false, true, false};
  CHECK(turn(router, {button(MouseButton::left, true)}, over).for_ui.size() == 1);
  CHECK_FALSE(router.is_captured());
  CHECK(turn(router, {button(MouseButton::left, true)}, waits).for_ui.size() == 1);
  CHECK_FALSE(router.is_captured());
}

TEST_CASE("a click after a movement waits until it is known what lies there", "[client_input]") {
  InputRouter router;
  router.push({CursorEvent{50, 50, 0, 0}, button(MouseButton::left, true)});
  CHECK(router.route({}).for_ui.size() == 1);
  CHECK_FALSE(router.is_captured());
  const UiFocus over{false, false, true};
  CHECK(router.route(over).for_ui.size() == 1);
  CHECK_FALSE(router.is_captured());
}

TEST_CASE("a window frees the mouse, and closing it captures the mouse again", "[client_input]") {
  InputRouter router;
  capture(router);
  turn(router, {key(Key::w, true)});
  router.set_windows(true, 0);
  CHECK_FALSE(router.is_captured());
  CHECK_FALSE(turn(router, {}).player.forward);  // a key that was held moves nobody any more
  router.set_windows(true, 0);
  router.set_windows(false, 0);
  CHECK(router.is_captured());
}

TEST_CASE("a panel frees the mouse when it opens, and a click beside it captures it again",
          "[client_input]") {
  InputRouter router;
  capture(router);
  router.set_windows(false, 1);
  CHECK_FALSE(router.is_captured());
  UiFocus focus;
  focus.panels = 1;
  focus.over_window = true;
  turn(router, {button(MouseButton::left, true), button(MouseButton::left, false)}, focus);
  CHECK_FALSE(router.is_captured());
  focus.over_window = false;
  turn(router, {button(MouseButton::left, true), button(MouseButton::left, false)}, focus);
  CHECK(router.is_captured());
  router.set_windows(true, 1);  // such as the chat
  CHECK_FALSE(router.is_captured());
  router.set_windows(false, 1);
  CHECK(router.is_captured());
  router.set_windows(false, 0);
  CHECK(router.is_captured());
}

TEST_CASE("a second panel frees the mouse too, until both are closed", "[client_input]") {
  InputRouter router;
  router.set_windows(false, 1);
  capture(router);
  router.set_windows(false, 2);
  CHECK_FALSE(router.is_captured());
  router.set_windows(false, 1);
  CHECK_FALSE(router.is_captured());
  router.set_windows(false, 0);
  CHECK(router.is_captured());
}

TEST_CASE("what comes after the key that frees the mouse waits for who opens then",
          "[client_input]") {
  InputRouter router;
  capture(router);
  const RoutedInput out =
      turn(router, {key(Key::escape, true), key(Key::down, true), key(Key::down, false)});
  CHECK_FALSE(router.is_captured());
  CHECK(out.for_ui.empty());
  CHECK(router.take_waiting().size() == 2);
  CHECK_FALSE(router.has_events());
}

TEST_CASE("what is held ends when other code takes the events", "[client_input]") {
  InputRouter router;
  capture(router);
  CHECK(turn(router, {key(Key::w, true)}).player.forward);
  router.release_all();
  CHECK_FALSE(turn(router, {}).player.forward);
  CHECK(router.is_captured());
  CHECK(turn(router, {key(Key::w, true)}).player.forward);
  router.release();
  CHECK_FALSE(turn(router, {}).player.forward);
  CHECK_FALSE(router.is_captured());
}

TEST_CASE("the interface sees control while the mouse is free, although it moves the player faster",
          "[client_input]") {
  InputRouter router;
  const RoutedInput pressed = turn(router, {key(Key::left_control, true)});
  CHECK(pressed.player.fast);
  CHECK(pressed.for_ui.size() == 1);
}

TEST_CASE("closing a panel captures the mouse only if it was captured before", "[client_input]") {
  InputRouter router;
  router.set_windows(false, 1);
  router.set_windows(false, 0);
  CHECK_FALSE(router.is_captured());
  capture(router);
  router.set_windows(false, 1);
  router.set_windows(true, 1);
  router.set_windows(true, 0);  // the panel closes under the window
  CHECK_FALSE(router.is_captured());
  router.set_windows(false, 0);
  CHECK(router.is_captured());
}

TEST_CASE("while a text is typed only function keys and escape act", "[client_input]") {
  InputRouter router;
  const RoutedInput typed =
      turn(router, {key(Key::e, true), CharacterEvent{U'e'}, key(Key::e, false), key(Key::w, true)},
           kTyping);
  CHECK(typed.player.actions.empty());
  CHECK_FALSE(typed.player.forward);
  CHECK(typed.for_ui.size() == 4);
  CHECK(turn(router, {key(Key::f2, true)}, kTyping).player.actions == Actions{Action::screenshot});
  CHECK(turn(router, {key(Key::escape, true)}, kTyping).player.actions == Actions{Action::release});
}

TEST_CASE("a window that scrolls gets the arrows while the mouse is free", "[client_input]") {
  InputRouter router;
  const UiFocus scrolls{.scrolls = true};
  for (const Key arrow : {Key::up, Key::down}) {
    const RoutedInput free = turn(router, {key(arrow, true), key(arrow, false)}, scrolls);
    CHECK(free.player.actions.empty());
    CHECK(free.for_ui.size() == 2);
  }
  CHECK(turn(router, {key(Key::left, true)}, scrolls).player.actions ==
        Actions{Action::nudge_left});
  CHECK(turn(router, {key(Key::up, true)}).player.actions == Actions{Action::nudge_away});
  capture(router);
  CHECK(turn(router, {key(Key::up, true)}, scrolls).player.actions == Actions{Action::nudge_away});
}

TEST_CASE("the character of a key that acts is typed nowhere, and later events wait",
          "[client_input]") {
  InputRouter router;
  router.push({key(Key::t, true), CharacterEvent{U't'}, key(Key::t, false), key(Key::h, true),
               CharacterEvent{U'h'}});
  const RoutedInput first = router.route({});
  CHECK(first.player.actions == Actions{Action::chat});
  CHECK(first.for_ui.empty());
  const RoutedInput second = router.route(kTyping);
  CHECK(second.player.actions.empty());
  REQUIRE(second.for_ui.size() == 3);
  CHECK(std::get<CharacterEvent>(second.for_ui[2]).character == U'h');
}

TEST_CASE("enter ends the turn of a text, because it may close the field", "[client_input]") {
  InputRouter router;
  router.push({key(Key::enter, true), key(Key::enter, false), key(Key::e, true)});
  CHECK(router.route(kTyping).for_ui.size() == 1);
  CHECK(router.route({}).player.actions == Actions{Action::palette});
}

TEST_CASE("escape frees the mouse first and acts second", "[client_input]") {
  InputRouter router;
  capture(router);
  CHECK(turn(router, {key(Key::escape, true)}).player.actions.empty());
  CHECK_FALSE(router.is_captured());
  CHECK(turn(router, {key(Key::escape, true)}).player.actions == Actions{Action::release});
}

TEST_CASE("keys act in their order, and a window without focus holds none", "[client_input]") {
  InputRouter router;
  capture(router);
  const RoutedInput held = turn(router, {key(Key::left_control, true), key(Key::w, true, true)});
  CHECK(held.player.fast);
  const RoutedInput walking = turn(router, {key(Key::left_control, false), key(Key::w, true)});
  CHECK(walking.player.forward);
  CHECK_FALSE(walking.player.fast);
  CHECK(turn(router, {key(Key::z, true, true)}).player.actions == Actions{Action::undo});
  CHECK_FALSE(turn(router, {FocusEvent{false}}).player.forward);
}
