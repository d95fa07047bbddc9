#include "common/os/program.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

namespace runstone {

Result<void, std::string> flush_standard_output() {
  errno = 0;
  std::cout.flush();
  const bool is_flushed = std::fflush(stdout) == 0;
  const int error = errno;
  const bool is_written = is_flushed && std::cout.good() && std::ferror(stdout) == 0;
  std::cout.clear();
  std::clearerr(stdout);
  if (is_written) return {};
  // The reason is unknown if an earlier write has failed.
  return failure(std::string("standard output could not be written completely") +
                 (error == 0 ? "" : std::string(": ") + std::strerror(error)));
}

int run_program(const char* name, int failed, const std::function<int()>& body) {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  int code = failed;
  try {
    code = body();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  }
  const auto written = flush_standard_output();
  if (written) return code;
  std::fprintf(stderr, "%s: %s\n", name, written.error().c_str());
  return code == 0 ? failed : code;
}

}  // namespace runstone
