// Functions that start child programs.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

struct ChildProgram {
  std::vector<std::string> words;  // program, searched on PATH if it has no '/', and arguments
  int in = -1, out = -1;           // descriptors of its standard input and output; -1: /dev/null
  std::string folder;              // its working directory; empty: that of this process
  int errors = -1;                 // of its standard error; -1: that of this process
};

/// Returns the path of a program to start: `wanted` if it is not empty, otherwise the value of the
/// environment variable `variable` if it is set, otherwise `name` in the folder of the running
/// program.
std::string sibling_program(const std::string& wanted, const char* variable,
                            const std::string& name);

/// Starts a child and returns its process id, or the errno value of the failure. The child inherits
/// the environment, but no descriptor other than these. No signal is blocked or ignored in
/// it. The caller must wait for it.
Result<pid_t, int> start_program(ChildProgram program);

/// Returns "ended with exit code 3" or "was ended by signal 9". `status` is a result of waitpid().
std::string how_it_ended(int status);

}  // namespace runstone
