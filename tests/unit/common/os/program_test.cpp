#include "common/os/program.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

constexpr int kFailed = 7;

/// Runs a program in another process whose standard output is `output`. Returns the status of its
/// end.
int status_of(const std::string& output, const std::function<int()>& body) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::dup2(::open(output.c_str(), O_WRONLY), STDOUT_FILENO);
    ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
    ::_exit(run_program("test", kFailed, body));
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return status;
}

int code_of(const std::string& output, const std::function<int()>& body) {
  const int status = status_of(output, body);
  REQUIRE(WIFEXITED(status));
  return WEXITSTATUS(status);
}

}  // namespace

TEST_CASE("a program ends with the code of its body, and otherwise as failed", "[os]") {
  CHECK(code_of("/dev/null", [] { return 0; }) == 0);
  CHECK(code_of("/dev/null", [] { return 3; }) == 3);
  CHECK(code_of("/dev/null", []() -> int { throw std::runtime_error("broken"); }) == kFailed);
  const auto print = [](int code) {
    return [code] {
      std::puts("text");
      return code;
    };
  };
  CHECK(code_of("/dev/full", print(0)) == kFailed);
  CHECK(code_of("/dev/full", print(3)) == 3);
}

TEST_CASE("a write that the system refuses fails, and no signal ends the program", "[os]") {
  const TempFolder folder;
  CHECK(code_of("/dev/null", [] {
          std::array<int, 2> ends{};
          if (::pipe(ends.data()) != 0) return 1;
          ::close(ends[0]);
          return ::write(ends[1], "x", 1) < 0 && errno == EPIPE ? 0 : 2;
        }) == 0);
  CHECK(code_of("/dev/null", [&] {
          const rlimit limit{16, 16};
          if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
          const int file = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT, 0600);
          const std::array<char, 32> bytes{};
          if (::write(file, bytes.data(), 16) != 16) return 2;
          return ::write(file, bytes.data(), 16) < 0 && errno == EFBIG ? 0 : 3;
        }) == 0);
}

}  // namespace runstone::test
