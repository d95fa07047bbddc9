#include "common/model_reader/process_limits.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <fstream>
#include <functional>
#include <string>

#include "common/model_reader/model_folder.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;

namespace {

constexpr std::uint64_t kMemoryBytes = std::uint64_t{1} << 30;
#ifdef RUNSTONE_SANITIZED
constexpr bool kIsBounded = false;
#else
constexpr bool kIsBounded = true;
#endif

/// Runs a function in a child process and returns what it returned, 0 .. 255, or -1 if the child did
/// not end by itself.
int in_child(const std::function<int()>& function) {
  const pid_t pid = ::fork();
  REQUIRE(pid >= 0);
  if (pid == 0) ::_exit(function());
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Returns true if a call failed because the filter refuses it.
bool is_refused(long result) { return result == -1 && errno == EPERM; }

}  // namespace

#if defined(__x86_64__) || defined(__aarch64__)
TEST_CASE("a limited process has no network, programs, children and signals", "[model_reader]") {
  const pid_t parent = ::getpid();
  CHECK(in_child([parent] {
          if (!limit_process({kMemoryBytes, 10}) || !refuse_other_calls()) return 1;
          if (!is_refused(::socket(AF_INET, SOCK_STREAM, 0))) return 2;
          if (!is_refused(::socket(AF_UNIX, SOCK_STREAM, 0))) return 3;
          char* const none[] = {nullptr};
          if (!is_refused(::execve("/bin/true", none, none))) return 4;
          if (!is_refused(::fork())) return 5;
          if (!is_refused(::kill(parent, 0))) return 6;
          if (!is_refused(::open("/tmp", O_WRONLY | O_TMPFILE, 0600))) return 7;
          if (!is_refused(::unlink("/gone"))) return 8;
          if (::getpid() == parent) return 9;  // what is allowed goes on
          return 0;
        }) == 0);
}
#endif

TEST_CASE("a confined process opens files of its folder only", "[model_reader]") {
  test::TempFolder temp;
  std::ofstream(temp / "a.obj") << "v 0 0 0";
  const int result = in_child([&temp] {
    if (!limit_process({kMemoryBytes, 10})) return 1;
    const auto folder = ModelFolder::of_file(temp / "a.obj");
    if (!folder) return 2;
    if (!folder->confine_process()) return 77;
    if (::open("/etc/passwd", O_RDONLY | O_CLOEXEC) >= 0) return 3;
    if (::open((temp / "new").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600) >= 0) return 4;
    if (!folder->open("a.obj")) return 5;
    return 0;
  });
  if (result == 77) {
    WARN("the kernel has no Landlock");
    return;
  }
  CHECK(result == 0);
}

TEST_CASE("a limited process has bounded memory and files", "[model_reader]") {
  CHECK(in_child([] {
          if (!limit_process({kMemoryBytes, 10})) return 1;
          void* const much = ::mmap(nullptr, 2 * kMemoryBytes, PROT_READ | PROT_WRITE,
                                    MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
          if (kIsBounded && much != MAP_FAILED) return 2;
          int opened = 0;
          while (opened < 100 && ::open("/dev/null", O_RDONLY | O_CLOEXEC) >= 0) ++opened;
          return opened < 40 ? 0 : 3;
        }) == 0);
}
