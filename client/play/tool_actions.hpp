// Tool actions: carries out the actions of the building keys on the tool box.
#pragma once
#include <optional>
#include <string>

#include "client/input/action.hpp"
#include "client/play/edit_tool.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Carries out an action of a key. Returns nullopt if the tools do not have this action. Otherwise
/// returns a line for the player, as the value or as the failure.
std::optional<Result<std::string, std::string>> act_on_tool(EditTool& tool, Action action,
                                                            TimeUs now_us);

}  // namespace runstone
