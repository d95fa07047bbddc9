// Command rules: which right each command needs, and the line about it in the command `help`.
#pragma once
#include <functional>
#include <string>

#include "common/rights/right.hpp"
#include "server/admin/command.hpp"

namespace runstone {

struct CommandRule {
  RightSet any_of;        // each of these rights suffices; empty: the command is for everybody
  bool is_local = false;  // for the console and `runstone-server control` only
};

/// Returns the rule of a command. Cost: O(1).
CommandRule rule_of(const Command& command);

/// Returns a text that lists the commands that someone may give who has the rights for which
/// `has_right` returns true. `is_local`: someone at the console or `runstone-server control`.
std::string command_help(const std::function<bool(Right)>& has_right, bool is_local);

}  // namespace runstone
