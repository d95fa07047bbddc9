// Completion of command lines in shells.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "common/command_line/command_help.hpp"

namespace runstone {

enum class CompletionShell { bash, zsh, fish };

/// Returns the shell of "bash", "zsh" or "fish", or nullopt.
std::optional<CompletionShell> parse_completion_shell(std::string_view text);

/// Returns a script that completes the options and subcommands of a program, and the values of options
/// that list them. Other values are completed as names of files.
std::string completion_script(const CommandHelp& program, CompletionShell shell);

}  // namespace runstone
