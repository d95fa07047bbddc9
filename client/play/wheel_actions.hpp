// Wheel actions: carries out the turns of the mouse wheel.
#pragma once
#include <optional>
#include <string>

#include "client/input/window_input.hpp"
#include "client/play/edit_tool.hpp"
#include "client/play/player.hpp"
#include "client/play/player_hotbar.hpp"

namespace runstone {

/// Carries out the turns of the wheel: they change
///   - the size of the tool, while the key for it is held;
///   - the speed of flight, while a player flies with the key that makes flight faster;
///   - the slot of the hotbar, otherwise.
/// Returns a line for the player, or nullopt if there is none.
std::optional<std::string> act_on_wheel(const WindowInput& input, EditTool& tool, Player& player,
                                        PlayerHotbar& hotbar);

}  // namespace runstone
