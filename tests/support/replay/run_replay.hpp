// runstone-replay as a function, for tests. They must link server/app.
#pragma once
#include <sstream>
#include <string>
#include <vector>

#include "server/replay/replay_program.hpp"

namespace runstone::test {

struct ReplayOutcome {
  int code;
  std::string out, err;
};

/// `arguments` do not include the program's name.
inline ReplayOutcome run_replay(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"runstone-replay"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out, err;
  const int code = replay_program(static_cast<int>(argv.size()), argv.data(), out, err);
  return {code, out.str(), err.str()};
}

}  // namespace runstone::test
