#include "bench/network/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "common/os/open_files.hpp"

namespace runstone::bench {
namespace {

volatile std::sig_atomic_t is_interrupted = 0;

void on_signal(int signal) {
  is_interrupted = 1;
  ::signal(signal, SIG_DFL);
}

/// Runs in the new process after fork(), where only system calls are allowed.
[[noreturn]] void become(char* const* words, const char* log) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  // The signals of the terminal are ignored, because the testbed ends its programs itself.
  ::signal(SIGINT, SIG_IGN);
  const int in = ::open("/dev/null", O_RDONLY);
  const int out = ::open(log, O_WRONLY | O_CREAT | O_APPEND, 0644);
  if (in >= 0 && out >= 0) {
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(out, STDERR_FILENO);
    ::close_range(STDERR_FILENO + 1, ~0U, 0);
    allow_open_files(std::numeric_limits<std::size_t>::max());  // a fleet has many sockets
    ::execv(words[0], words);
  }
  ::_exit(127);
}

}  // namespace

bool interrupted() { return is_interrupted != 0; }

void take_interrupts() {
  ::signal(SIGINT, on_signal);
  ::signal(SIGTERM, on_signal);
}

bool pause_for(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!interrupted()) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= end) return true;
    std::this_thread::sleep_for(
        std::min<std::chrono::duration<double>>(end - now, std::chrono::milliseconds(50)));
  }
  return false;
}

Child::Child(pid_t pid, std::string name, std::string log)
    : pid_(pid), name_(std::move(name)), log_(std::move(log)) {}

Result<std::unique_ptr<Child>, std::string> Child::start(Place& place,
                                                         std::vector<std::string> words,
                                                         std::string log) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string name = std::filesystem::path(words[0]).filename();
  if (::access(words[0].c_str(), X_OK) != 0) {
    return failure("cannot run " + words[0] + ": " + std::strerror(errno));
  }
  pid_t pid = -1;
  int why = 0;
  place.run([&] {
    pid = ::fork();
    why = errno;
    if (pid == 0) become(arguments.data(), log.c_str());
  });
  if (pid < 0) return failure("cannot start " + name + ": " + std::strerror(why));
  return std::unique_ptr<Child>(new Child(pid, name, std::move(log)));
}

Child::~Child() {
  if (status_) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

std::optional<int> Child::wait(double seconds) {
  wait_until(seconds, [this] {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
    return status_.has_value();
  });
  return status_;
}

void Child::terminate() {
  if (!status_) ::kill(pid_, SIGTERM);
}

double Child::core_seconds() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/stat");
  std::string text;
  std::getline(file, text);
  // The name is in brackets and may contain anything. After it utime and stime are the 12th and
  // 13th words.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return 0;
  std::istringstream words(text.substr(name_end + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) words >> skipped;
  double user = 0, system = 0;
  words >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

std::uint64_t Child::resident_bytes() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t Child::written_bytes() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/io");
  std::uint64_t bytes = 0;
  for (std::string name; file >> name >> bytes;) {
    if (name == "write_bytes:") return bytes;
  }
  return 0;
}

std::size_t Child::open_files() const {
  std::error_code ignored;
  const std::filesystem::directory_iterator files("/proc/" + std::to_string(pid_) + "/fd", ignored);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

std::string Child::explain(const std::string& what) const {
  constexpr std::size_t kLines = 8;
  std::ifstream file(log_);
  std::deque<std::string> last;
  for (std::string line; std::getline(file, line);) {
    last.push_back(line);
    if (last.size() > kLines) last.pop_front();
  }
  std::string out = name_ + " " + what + "; the end of its output:";
  for (const std::string& line : last) out += "\n  " + line;
  return out;
}

}  // namespace runstone::bench
