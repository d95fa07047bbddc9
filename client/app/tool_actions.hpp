// Tool actions: what the keys of building do with the tool box.
#pragma once
#include <optional>
#include <string>

#include "client/app/edit_tool.hpp"
#include "client/input/action.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Carries out an action of a key. Returns nullopt if the action is none of the tools. Otherwise
/// returns a line for the player, which is also the value of a failure.
std::optional<Result<std::string, std::string>> act_on_tool(EditTool& tool, Action action,
                                                            TimeUs now_us);

}  // namespace runstone
