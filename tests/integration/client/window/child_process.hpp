// ChildProcess: a program that a test starts and waits for. The destructor ends it by its process
// id.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace runstone::test {

/// Returns the path of `program` on PATH, or nullopt if it is not installed.
inline std::optional<std::string> find_program(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = folder + "/" + program;
    if (::access(file.c_str(), X_OK) == 0) return file;
  }
  return std::nullopt;
}

/// Calls `ready` until it returns true or the time is over. Returns the last result.
template <class Ready>
bool wait_for(std::chrono::milliseconds longest, const Ready& ready) {
  const auto end = std::chrono::steady_clock::now() + longest;
  while (!ready()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

class ChildProcess {
 public:
  /// `words` are the program and its arguments. `output` is the file for standard output and error.
  /// `environment` has NAME=VALUE pairs to add. `kept` is a descriptor that the child inherits with
  /// the same number, or -1.
  ChildProcess(std::vector<std::string> words, const std::string& output,
               std::vector<std::string> environment = {}, int kept = -1) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int out = ::open(output.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644);
    REQUIRE(out >= 0);
    child_ = ::fork();
    if (child_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // also when the test itself is killed
      ::dup2(out, STDOUT_FILENO);
      ::dup2(out, STDERR_FILENO);
      // A listening socket of the test that stayed open in the child would keep its port in use.
      ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
      if (kept >= 0) ::fcntl(kept, F_SETFD, 0);
      for (std::string& variable : environment) ::putenv(variable.data());
      ::execv(arguments[0], arguments.data());
      ::_exit(127);
    }
    ::close(out);
    REQUIRE(child_ > 0);
  }
  ~ChildProcess() {
    if (child_ <= 0) return;
    ::kill(child_, SIGTERM);  // on this signal an X server removes its socket
    if (wait(std::chrono::seconds(10)) || child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Waits for the end. Returns the exit code, or nullopt if the time is over or a signal ended the
  /// program.
  std::optional<int> wait(std::chrono::milliseconds longest) {
    int status = 0;
    if (!wait_for(longest, [&] { return ::waitpid(child_, &status, WNOHANG) == child_; }))
      return std::nullopt;
    child_ = -1;
    if (!WIFEXITED(status)) return std::nullopt;
    return WEXITSTATUS(status);
  }

 private:
  pid_t child_ = -1;
};

}  // namespace runstone::test
