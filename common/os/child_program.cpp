#include "common/os/child_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace runstone {
namespace {

/// The settings for posix_spawn(), freed with this object.
struct SpawnSettings {
  SpawnSettings() {
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawnattr_init(&attributes);
  }
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&files);
    ::posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  /// Gives the child `descriptor`, or /dev/null if it is negative, as its descriptor `as`.
  void give(int descriptor, int as, int mode) {
    if (descriptor >= 0) {
      ::posix_spawn_file_actions_adddup2(&files, descriptor, as);
    } else {
      ::posix_spawn_file_actions_addopen(&files, as, "/dev/null", mode, 0);
    }
  }

  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
};

}  // namespace

std::string sibling_program(const std::string& wanted, const char* variable,
                            const std::string& name) {
  if (!wanted.empty()) return wanted;
  if (const char* named = std::getenv(variable); named != nullptr && *named != '\0') return named;
  std::error_code unknown;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  return unknown ? name : (self.parent_path() / name).string();
}

Result<pid_t, int> start_program(ChildProgram program) {
  SpawnSettings settings;
  settings.give(program.in, STDIN_FILENO, O_RDONLY);
  settings.give(program.out, STDOUT_FILENO, O_WRONLY);
  if (program.errors >= 0) settings.give(program.errors, STDERR_FILENO, O_WRONLY);
  // Libraries may have opened descriptors without FD_CLOEXEC.
  ::posix_spawn_file_actions_addclosefrom_np(&settings.files, STDERR_FILENO + 1);
  if (!program.folder.empty()) {
    ::posix_spawn_file_actions_addchdir_np(&settings.files, program.folder.c_str());
  }
  sigset_t signals;
  ::sigemptyset(&signals);
  ::posix_spawnattr_setsigmask(&settings.attributes, &signals);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP})
    ::sigaddset(&signals, signal);
  ::posix_spawnattr_setsigdefault(&settings.attributes, &signals);
  ::posix_spawnattr_setflags(&settings.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::vector<char*> arguments;
  arguments.reserve(program.words.size() + 1);
  for (std::string& word : program.words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int wrong = ::posix_spawnp(&pid, arguments[0], &settings.files, &settings.attributes,
                                   arguments.data(), environ);
  if (wrong != 0) return failure(wrong);
  return pid;
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) return "was ended by signal " + std::to_string(WTERMSIG(status));
  return "ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace runstone
