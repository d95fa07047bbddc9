// The hidden options `--help-man` and `--completion SHELL`, which print the man page of a program and
// its completion for a shell. Packages hold their output.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/command_line/command_help.hpp"

namespace CLI {
class App;
}

namespace runstone {

/// Returns the options and subcommands of `app` that `--help` shows, under the given name.
CommandHelp command_help(const CLI::App& app, std::string name);

/// Returns subcommands that a program parses by itself, so that its CLI::App does not have them.
using MoreSubcommands = std::function<std::vector<CommandHelp>()>;

/// Adds the hidden options to `app`, the command line of `program`. Each of them prints its text and
/// ends the parsing as `--version` does: parse() throws, and CLI::App::exit() prints and returns 0.
/// Options and subcommands that are added later are in the text, too. `app` must outlive the parsing.
void add_help_options(CLI::App& app, const std::string& program, MoreSubcommands more = {});

/// Returns true for a word of a command line that is one of the hidden options.
bool is_help_option(std::string_view word);

}  // namespace runstone
