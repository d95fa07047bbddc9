// Child programs: how ours start others.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

struct ChildProgram {
  std::vector<std::string> words;  // program (looked for on PATH if it has no '/') and arguments
  int in = -1, out = -1;           // become its standard input and output; -1: nothing, /dev/null
  std::string folder;              // in which it runs; empty: ours
};

/// Which program to start: `wanted` if it is not empty, else what the environment's `variable` names, else the one
/// called `name` in the folder of the running program.
std::string sibling_program(const std::string& wanted, const char* variable,
                            const std::string& name);

/// Starts it and returns its process id, or an error number. It has our environment and standard error, no other file or
/// socket of ours, and no signal is blocked or ignored in it. Whoever started it has to wait for it.
Result<pid_t, int> start_program(ChildProgram program);

/// "ended with exit code 3" or "was ended by signal 9": of a status that waitpid() gave.
std::string how_it_ended(int status);

}  // namespace runstone
