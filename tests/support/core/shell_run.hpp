// Runs a command line and returns what it printed.
#pragma once
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "common/core/assert.hpp"

namespace runstone::test {

struct ShellRun {
  std::string text;  // of standard output
  int exit_code = -1;
};

inline ShellRun run_shell(const std::string& command) {
  ShellRun out;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  RUNSTONE_ASSERT(pipe != nullptr);
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    out.text.append(buffer.data(), count);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) out.exit_code = WEXITSTATUS(status);
  return out;
}

}  // namespace runstone::test
