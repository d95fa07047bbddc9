#include "client/input/gamepad.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>

#include "client/input/input_router.hpp"

using namespace runstone;

namespace {

/// A gamepad whose events a router gets.
struct PadBench {
  RoutedInput turn(const std::optional<GamepadSample>& sample, const UiFocus& focus = {}) {
    std::vector<InputEvent> events;
    reader.read(sample, events);
    event_count = events.size();
    router.push(events);
    return router.route(focus);
  }
  static GamepadSample pressed(GamepadButton button) {
    GamepadSample out;
    out.buttons[static_cast<std::size_t>(button)] = true;
    return out;
  }

  GamepadReader reader;
  InputRouter router;
  std::size_t event_count = 0;
};

}  // namespace

TEST_CASE_METHOD(PadBench, "the sticks of a gamepad move and turn, beyond their dead zone",
                 "[client_input]") {
  GamepadSample sample;
  sample.axes[1] = -1;
  sample.axes[2] = 0.6F;
  WindowInput input = turn(sample).player;
  CHECK(input.forward);
  CHECK_FALSE(input.back);
  CHECK(input.turn_x == Approx(0.25));
  CHECK(input.turn_y == 0);
  turn(sample);
  CHECK(event_count == 0);  // nothing has changed
  sample.axes = {0.1F, 0.19F, -0.1F, std::numeric_limits<float>::quiet_NaN(), -1, -1};
  input = turn(sample).player;
  CHECK_FALSE(input.forward);
  CHECK_FALSE(input.back);
  CHECK(input.turn_x == 0);
  CHECK(input.turn_y == 0);
}

TEST_CASE_METHOD(PadBench,
                 "a trigger is a mouse button with a press and a time in which it is held",
                 "[client_input]") {
  GamepadSample sample;
  sample.axes[5] = 0.9F;
  WindowInput input = turn(sample).player;
  CHECK(input.remove_clicks == 1);
  CHECK(input.remove_held);
  input = turn(sample).player;
  CHECK(input.remove_clicks == 0);
  CHECK(input.remove_held);
  sample.axes[5] = -0.5F;
  sample.axes[4] = 1;
  input = turn(sample).player;
  CHECK_FALSE(input.remove_held);
  CHECK(input.place_clicks == 1);
}

TEST_CASE_METHOD(PadBench, "each button of the table does what the table says", "[client_input]") {
  for (const GamepadBinding& row : gamepad_table()) {
    if (row.button >= GamepadButton::left_trigger) continue;
    CAPTURE(std::string(row.name));
    const WindowInput input = turn(pressed(row.button)).player;
    if (row.action && !info_of(*row.action).is_held) {
      CHECK(input.actions == std::vector<Action>{*row.action});
    } else {
      CHECK(input.actions.empty());
      CHECK(int{input.up} + int{input.down} + int{input.fast} + input.pick_clicks +
                std::abs(input.scroll) ==
            1);
    }
    CHECK(turn(GamepadSample{}).player.actions.empty());
  }
}

TEST_CASE_METHOD(PadBench, "a gamepad that is pulled out releases everything", "[client_input]") {
  GamepadSample sample = pressed(GamepadButton::a);
  sample.axes[0] = 1;
  sample.axes[4] = 1;
  CHECK(turn(sample).player.up);
  const WindowInput input = turn(std::nullopt).player;
  CHECK_FALSE(input.up);
  CHECK_FALSE(input.right);
  CHECK_FALSE(input.place_held);
}

TEST_CASE_METHOD(PadBench, "while a window needs the mouse, only start acts", "[client_input]") {
  UiFocus focus;
  focus.has_window = true;
  CHECK(turn(pressed(GamepadButton::x), focus).player.actions.empty());
  turn(GamepadSample{}, focus);
  CHECK(turn(pressed(GamepadButton::start), focus).player.actions ==
        std::vector<Action>{Action::release});
}
