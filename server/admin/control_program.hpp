// runstone-server control: sends one command to a running server and prints the answer.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

struct ControlRequest {
  std::string world = "world";     // folder
  std::vector<std::string> words;  // of the command, as the shell passed them
};

/// Returns the command as one line. A single word is the whole line, as a person would type it at
/// the console. Of several words, those that contain blanks are put in quotes, because the shell
/// has removed the quotes around them.
std::string control_line(const std::vector<std::string>& words);

/// Sends the command and prints each line of the answer to `out` as it arrives. Returns true if the
/// command succeeded. The error is one line: the command has control characters such as a newline,
/// or no server runs that world. Blocks until the answer is complete.
Result<bool, std::string> control_server(const ControlRequest& request, std::ostream& out);

}  // namespace runstone
