#include "client/input/touch_pad.hpp"

#include <catch2/catch.hpp>
#include <variant>

using namespace runstone;

namespace {

/// A phone held upright, with a thumb on each side.
struct Phone {
  Phone() { pad.set_size(360, 640); }

  template <class Event>
  std::vector<Event> take() {
    std::vector<Event> out;
    for (const InputEvent& event : pad.take_events()) {
      if (const auto* wanted = std::get_if<Event>(&event)) out.push_back(*wanted);
    }
    return out;
  }
  std::vector<ButtonEvent> buttons() { return take<ButtonEvent>(); }

  TouchPad pad;
};

constexpr double kStickX = 60, kStickY = 540, kLookX = 250, kLookY = 200;

}  // namespace

TEST_CASE("a touch at the lower left is a stick around the place where it began", "[input]") {
  Phone phone;
  phone.pad.begin(1, kStickX, kStickY, 0);
  phone.pad.move(1, kStickX, kStickY - TouchPad::kStickReach / 2);
  auto sticks = phone.take<StickEvent>();
  REQUIRE(sticks.size() == 1);
  CHECK(sticks[0].move_x == 0);
  CHECK(sticks[0].move_y == Approx(-0.5));
  phone.pad.move(1, kStickX + 500, kStickY);
  sticks = phone.take<StickEvent>();
  REQUIRE(sticks.size() == 1);
  CHECK(sticks[0].move_x == 1);
  phone.pad.end(1, 10'000);
  sticks = phone.take<StickEvent>();
  REQUIRE(sticks.size() == 1);
  CHECK(sticks[0] == StickEvent{});
}

TEST_CASE("a second touch turns the player while the first one moves", "[input]") {
  Phone phone;
  phone.pad.begin(1, kStickX, kStickY, 0);
  phone.pad.begin(2, kLookX, kLookY, 0);
  phone.pad.move(2, kLookX + 30, kLookY - 20);
  const auto turns = phone.take<CursorEvent>();
  REQUIRE(turns.size() == 1);
  CHECK(turns[0].dx == 30 * TouchPad::kTurnPerPixel);
  CHECK(turns[0].dy == -20 * TouchPad::kTurnPerPixel);
  phone.pad.end(2, 100'000);
  CHECK(phone.buttons().empty());  // it moved, so it was no tap
}

TEST_CASE("a short touch clicks by the chosen mode", "[input]") {
  Phone phone;
  phone.pad.begin(1, kLookX, kLookY, 0);
  phone.pad.move(1, kLookX + 2, kLookY);  // a finger never rests
  phone.pad.end(1, 100'000);
  auto buttons = phone.buttons();
  REQUIRE(buttons.size() == 2);
  CHECK(buttons[0].button == MouseButton::right);
  CHECK(buttons[0].is_pressed);
  CHECK_FALSE(buttons[1].is_pressed);
  phone.pad.set_mode(TapMode::remove);
  phone.pad.begin(1, kLookX, kLookY, 200'000);
  phone.pad.end(1, 300'000);
  buttons = phone.buttons();
  REQUIRE(buttons.size() == 2);
  CHECK(buttons[0].button == MouseButton::left);
}

TEST_CASE("a touch that rests holds the button until it ends", "[input]") {
  Phone phone;
  phone.pad.set_mode(TapMode::remove);
  phone.pad.begin(1, kLookX, kLookY, 0);
  phone.pad.step(TouchPad::kHoldUs - 1);
  CHECK(phone.buttons().empty());
  phone.pad.step(TouchPad::kHoldUs);
  auto buttons = phone.buttons();
  REQUIRE(buttons.size() == 1);
  CHECK(buttons[0].is_pressed);
  phone.pad.set_mode(TapMode::place);  // the button that is held is released all the same
  phone.pad.end(1, 2 * TouchPad::kHoldUs);
  buttons = phone.buttons();
  REQUIRE(buttons.size() == 1);
  CHECK(buttons[0].button == MouseButton::left);
  CHECK_FALSE(buttons[0].is_pressed);
}

TEST_CASE("cancelled touches leave nothing held and click nothing", "[input]") {
  Phone phone;
  phone.pad.begin(1, kStickX, kStickY, 0);
  phone.pad.move(1, kStickX + 60, kStickY);
  phone.pad.begin(2, kLookX, kLookY, 0);
  phone.pad.step(TouchPad::kHoldUs);
  phone.pad.begin(3, kLookX, kLookY, TouchPad::kHoldUs);
  static_cast<void>(phone.pad.take_events());
  phone.pad.cancel();
  std::size_t releases = 0, rests = 0;
  for (const InputEvent& event : phone.pad.take_events()) {
    if (const auto* button = std::get_if<ButtonEvent>(&event)) {
      CHECK_FALSE(button->is_pressed);
      ++releases;
    }
    if (const auto* stick = std::get_if<StickEvent>(&event)) {
      CHECK(*stick == StickEvent{});
      ++rests;
    }
  }
  CHECK(releases == 1);
  CHECK(rests == 1);
  phone.pad.move(2, 0, 0);
  phone.pad.end(1, 3 * TouchPad::kHoldUs);
  CHECK(phone.pad.take_events().empty());
}
