// runstone-server control: gives a running server one command and prints its answer.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

struct ControlRequest {
  std::string world = "world";     // folder
  std::vector<std::string> words;  // of the command
};

/// Whether the command did what it was asked. Prints each line of the answer as it comes. The error is one line:
/// no server runs that world. Blocks until the answer is complete.
Result<bool, std::string> control_server(const ControlRequest& request, std::ostream& out);

}  // namespace runstone
