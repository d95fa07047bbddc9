#include "client/input/gamepad.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace runstone {
namespace {

using enum GamepadButton;

constexpr std::array<GamepadBinding, 15> kGamepadTable = {{
    {right_trigger, "right trigger", std::nullopt,
     "remove with the tool, as the left mouse button"},
    {left_trigger, "left trigger", std::nullopt, "place with the tool, as the right mouse button"},
    {right_stick, "right stick pressed", std::nullopt, "take the material of the voxel in sight"},
    {left_bumper, "left bumper", std::nullopt, "choose the slot to the left"},
    {right_bumper, "right bumper", std::nullopt, "choose the slot to the right"},
    {a, "A", Action::move_up, ""},
    {b, "B", Action::move_down, ""},
    {left_stick, "left stick pressed", Action::move_fast, ""},
    {x, "X", Action::next_tool, ""},
    {y, "Y", Action::tools, ""},
    {left, "left", Action::undo, ""},
    {right, "right", Action::redo, ""},
    {up, "up", Action::palette, ""},
    {down, "down", Action::walk_or_fly, ""},
    {start, "start", Action::release, ""},
}};

/// Returns the way of a stick beyond its dead zone, -1 to 1. Small ways turn slowly.
double way_of(float axis) {
  const double way = std::clamp<double>(std::isfinite(axis) ? axis : 0, -1, 1);
  const double beyond = (std::abs(way) - GamepadReader::kDeadZone) / (1 - GamepadReader::kDeadZone);
  return beyond <= 0 ? 0 : std::copysign(beyond * beyond, way);
}

}  // namespace

void GamepadReader::read(const std::optional<GamepadSample>& sample, std::vector<InputEvent>& out) {
  const GamepadSample now = sample.value_or(GamepadSample{});
  const auto add = [&](GamepadButton button, bool was, bool is) {
    if (was != is) out.emplace_back(GamepadButtonEvent{button, is});
  };
  for (std::size_t i = 0; i < now.buttons.size(); ++i)
    add(static_cast<GamepadButton>(i), last_.buttons[i], now.buttons[i]);
  add(left_trigger, last_.axes[4] > 0, now.axes[4] > 0);
  add(right_trigger, last_.axes[5] > 0, now.axes[5] > 0);
  const StickEvent sticks{way_of(now.axes[0]), way_of(now.axes[1]), way_of(now.axes[2]),
                          way_of(now.axes[3])};
  if (sticks != sticks_) out.emplace_back(sticks);
  sticks_ = sticks;
  last_ = now;
}

std::span<const GamepadBinding> gamepad_table() { return kGamepadTable; }

}  // namespace runstone
