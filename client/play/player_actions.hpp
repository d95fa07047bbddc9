// Player actions: carries out the building keys and the turns of the mouse wheel.
#pragma once
#include <optional>
#include <string>

#include "client/input/window_input.hpp"
#include "client/play/edit_tool.hpp"
#include "client/play/hotbar.hpp"
#include "client/play/player.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Carries out an action of a key on the tool box. Returns nullopt if the tools do not have this
/// action. Otherwise returns a line for the player, as the value or as the failure.
std::optional<Result<std::string, std::string>> act_on_tool(EditTool& tool, Action action,
                                                            TimeUs now_us);

/// Carries out the turns of the wheel: they change
///   - the size of the tool, while the key for it is held;
///   - the speed of flight, while a player flies with the key that makes flight faster;
///   - the slot of the hotbar, otherwise.
/// Returns a line for the player, or nullopt if there is none.
std::optional<std::string> act_on_wheel(const WindowInput& input, EditTool& tool, Player& player,
                                        Hotbar& hotbar);

}  // namespace runstone
