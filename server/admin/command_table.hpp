// The table of commands: those of the console, of `runstone-server control` and of clients.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

/// Returns all commands, in the order of `help`.
const std::vector<CommandRow>& command_table();
/// Returns the row of a line with these words, or null. Cost: O(rows).
const CommandRow* find_command(const std::vector<std::string>& words);

/// Parses one line without its line break, of at most kCommandBytesMax bytes. Blanks separate
/// words; a word that contains blanks stands in double quotes. `now_us` (UTC) is the time to which
/// ages such as "since 1h" refer. The error is one line of text for the person who typed the
/// command: it names the wrong word and lists what is allowed in its place.
Result<Command, std::string> parse_command(std::string_view line, TimeUs now_us);

/// Returns a text that lists the commands that someone may give who has the rights for which
/// `has_right` returns true. `is_local`: someone at the console or `runstone-server control`.
std::string command_help(const std::function<bool(Right)>& has_right, bool is_local);

/// Returns the text of a line for the server's log. Somebody may type a secret itself by mistake.
std::string logged_command(const std::string& line);

/// Carries out one line. Thread: the world strand, where the call's `reply` is called. The reply
/// must not give a command.
void give_command(const CommandCall& call, const std::string& line);
/// Carries out one line at a server that follows the owner of its world.
void give_command(const FollowerCall& call, const std::string& line);

}  // namespace runstone
