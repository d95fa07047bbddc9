#include "server/replay/play_into.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "common/os/child_program.hpp"
#include "server/replay/rlog_file.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

Unexpected<std::string> failure(std::string line) { return {std::move(line)}; }

/// A folder for one file, gone with it.
class PassingFolder {
 public:
  PassingFolder() {
    std::error_code none;
    const auto parent = std::filesystem::temp_directory_path(none);
    if (none) {
      error_ = "no folder for temporary files, see TMPDIR: " + none.message();
      return;
    }
    std::string pattern = (parent / "runstone-play-XXXXXX").string();
    if (::mkdtemp(pattern.data()) != nullptr) {
      path_ = pattern;
    } else {
      error_ = parent.string() + ": no temporary folder can be made: " + std::strerror(errno);
    }
  }
  ~PassingFolder() {
    std::error_code ignored;  // nothing is left to do about it
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  const std::string& path() const { return path_; }
  /// Why there is none; empty: there is one.
  const std::string& error() const { return error_; }

 private:
  std::string path_, error_;
};

volatile std::sig_atomic_t signal_caught = 0;

/// While it lives, SIGINT and SIGTERM are only noted, so that neither ends the program before it has cleaned up. One at
/// a time.
class NotedSignals {
 public:
  NotedSignals() {
    signal_caught = 0;
    struct sigaction note{};
    note.sa_handler = [](int signal) { signal_caught = signal; };
    for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &note, &before_[i]);
  }
  ~NotedSignals() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
  }
  NotedSignals(const NotedSignals&) = delete;
  NotedSignals& operator=(const NotedSignals&) = delete;

  /// The last one that came since it was asked; 0: none.
  int take() const {
    const int signal = signal_caught;
    if (signal != 0) signal_caught = 0;
    return signal;
  }

 private:
  static constexpr std::array<int, 2> kSignals = {SIGINT, SIGTERM};
  std::array<struct sigaction, 2> before_{};
};

}  // namespace

Result<int, std::string> play_into(const ReplayOptions& options) {
  const NotedSignals signals;
  const PassingFolder folder;
  if (!folder.error().empty()) return failure(folder.error());
  const std::string file = folder.path() + "/log.rlog";
  {
    auto store = open_world(options.world, StoreAccess::read_only);
    if (!store) return failure(store.error().message());
    const auto done = export_rlog(**store, file, options.at);
    if (!done) return failure(done.error());
  }
  if (signals.take() != 0) return failure("stopped");
  const std::string program = sibling_program(options.bot, "RUNSTONE_BOT", "runstone-bot");
  std::vector<std::string> words = {program,      "--play",  file,         "--connect",
                                    options.into, "--speed", options.speed};
  if (!options.json.empty()) words.insert(words.end(), {"--report", options.json});
  const auto child = start_program({std::move(words), -1, STDOUT_FILENO, ""});
  if (!child) {
    return failure(program + ": cannot be started: " + std::strerror(child.error()) +
                   "; --bot PATH or RUNSTONE_BOT says where runstone-bot is");
  }
  for (;;) {
    int status = 0;
    const pid_t ended = ::waitpid(*child, &status, WNOHANG);
    if (ended == *child && WIFEXITED(status)) return WEXITSTATUS(status);
    if (ended == *child) return failure(program + ": " + how_it_ended(status));
    if (ended < 0 && errno != EINTR) return failure(program + ": is no child of ours any more");
    if (const int signal = signals.take(); signal != 0) ::kill(*child, signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace runstone
