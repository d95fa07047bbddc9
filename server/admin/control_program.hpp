// runstone-server control: sends one command to a running server and prints the answer.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

struct ControlRequest {
  std::string world = "world";     // folder
  std::vector<std::string> words;  // of the command, as the shell passed them
};

/// Returns the words of a command. Names of files that the server reads or writes become whole
/// paths, because the server may run in another folder. Words in quotes stay as they are.
std::vector<std::string> with_whole_paths(std::vector<std::string> words);

/// Returns the command as one line. A single word is the whole line, as a person would type it at
/// the console. Of several words, those that contain blanks are put in quotes, because the shell
/// has removed the quotes around them.
std::string control_line(const std::vector<std::string>& words);

/// Returns a new password: typed twice at the terminal without being shown or, if standard input is
/// no terminal, its first line.
Result<std::string, std::string> read_new_password();
/// Returns the line with what its command adds to it here (CommandRow::complete). A password is
/// read for `password set` alone.
Result<std::string, std::string> completed_line(const std::string& line,
                                                const ReadPassword& read_password);

/// How a command of `runstone-server control` ended.
enum class ControlEnd {
  done,     // it succeeded, and its record is on disk if it made one
  refused,  // it did not succeed
  unsaved,  // it is in force, but not on disk yet
};

/// Sends the command and prints each line of the answer to `out` as it arrives. The error is one
/// line: the command has control characters such as a newline, or no server runs that world. Blocks
/// until the answer is complete, or is that the command is in force and not on disk yet.
Result<ControlEnd, std::string> control_server(
    const ControlRequest& request, std::ostream& out,
    const ReadPassword& read_password = read_new_password);

}  // namespace runstone
