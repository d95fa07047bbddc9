#include "server/replay/replay_commands.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "common/os/child_program.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/rlog_file.hpp"
#include "server/store/store.hpp"

namespace runstone {
namespace {

constexpr double kSpeedMax = 1'000'000;

/// Checks the speed before the log is exported. runstone-bot has the same rule.
bool is_speed(const std::string& text) {
  double speed = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, speed);
  const bool is_number = error == std::errc{} && rest == end;
  return text == "max" || (is_number && speed >= 0 && speed <= kSpeedMax);
}

/// A folder for temporary files. The destructor removes it with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
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
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }
  /// Returns why the folder could not be made, or "" if it exists.
  const std::string& error() const { return error_; }

 private:
  std::string path_, error_;
};

volatile std::sig_atomic_t signal_caught = 0;

/// Records SIGINT and SIGTERM while it lives, so that neither ends the program before the temporary
/// file is removed. At most one object exists at a time.
class SignalRecorder {
 public:
  SignalRecorder() {
    signal_caught = 0;
    struct sigaction record{};
    record.sa_handler = [](int signal) { signal_caught = signal; };
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &record, &before_[i]);
  }
  ~SignalRecorder() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
  }
  SignalRecorder(const SignalRecorder&) = delete;
  SignalRecorder& operator=(const SignalRecorder&) = delete;

  /// Returns the last signal since the previous call, or 0 if there was none.
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

void declare_play(SubcommandOptions& command_line, PlayOptions& options) {
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.text("--connect", options.connect, "HOST:PORT of the live server",
                    SubcommandOptions::Presence::required);
  command_line.moment("--at", options.at, "last edit to play");
  command_line.parsed(
      "--speed",
      [&options](const std::string& text) -> std::string {
        if (!is_speed(text)) return "expected 0 to 1000000, or max";
        options.speed = text;
        return {};
      },
      "2 is twice as fast as recorded; 0 or max is as fast as the server accepts it; default 1");
  command_line.flag("--insecure", options.insecure,
                    "do not encrypt the connection; for a server that runs with --insecure");
  command_line.text("--bot", options.bot,
                    "path of runstone-bot; default: RUNSTONE_BOT, or runstone-bot beside this one");
}

Result<int, std::string> run_play(const PlayOptions& options, std::ostream& out) {
  const SignalRecorder signals;
  const TemporaryFolder folder;
  if (!folder.error().empty()) return failure(folder.error());
  const std::string file = folder.path() + "/log.rlog";
  {
    auto store = open_world(options.common.world, StoreAccess::read_only);
    if (!store) return failure(store.error().message());
    print_loss(out, **store);
    const auto at = end_of_replay(**store, options.at);
    if (!at) return failure(at.error());
    const auto done = export_rlog(**store, file, *at);
    if (!done) return failure(done.error());
  }
  if (signals.take() != 0) return failure("stopped");
  const std::string program = sibling_program(options.bot, "RUNSTONE_BOT", "runstone-bot");
  std::vector<std::string> words = {program,         "--play",  file,         "--connect",
                                    options.connect, "--speed", options.speed};
  if (options.insecure) words.emplace_back("--insecure");
  if (!options.common.json.empty()) {
    words.insert(words.end(), {"--report", options.common.json});
  }
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
    if (ended < 0 && errno != EINTR) return failure(program + ": is no longer a child process");
    if (const int signal = signals.take(); signal != 0) ::kill(*child, signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace runstone
