#include "server/app/backup_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "common/os/child_program.hpp"

namespace runstone {
namespace {

constexpr std::chrono::milliseconds kLook{100};  // between two looks whether the program must end

/// Reads what there is, or waits for it a moment. Returns false at the end of the output.
bool read_output(int output, std::string& text) {
  pollfd ready{output, POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(kLook.count())) <= 0) return true;
  std::array<char, 4096> part{};
  const ssize_t bytes = ::read(output, part.data(), part.size());
  if (bytes > 0) text.append(part.data(), static_cast<std::size_t>(bytes));
  return bytes > 0 || (bytes < 0 && errno == EINTR);
}

/// Returns true if the program has ended. It stays a zombie.
bool has_ended(pid_t pid) {
  siginfo_t ended{};
  const int found = ::waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOWAIT | WNOHANG);
  return found == 0 ? ended.si_pid == pid : errno != EINTR;
}

}  // namespace

BackupChild::~BackupChild() { stop(); }

void BackupChild::start(const std::string& folder, CommandReply reply) {
  run({"backup", "--world", world_, "--to", folder}, std::move(reply));
}

void BackupChild::run(const std::vector<std::string>& arguments, CommandReply reply) {
  const std::lock_guard lock(mutex_);
  if (is_stopped_) return refuse(reply, "backup: the server stops");
  if (pid_ >= 0) return refuse(reply, "backup: another one is under way");
  if (reader_.joinable()) reader_.join();  // it has ended
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return refuse(reply, std::string("backup: no pipe: ") + std::strerror(errno));
  }
  const std::string program = sibling_program("", "RUNSTONE_SERVER", "runstone-server");
  ChildProgram child;
  child.words = {program};
  child.words.insert(child.words.end(), arguments.begin(), arguments.end());
  child.out = child.errors = ends[1];
  const auto pid = start_program(std::move(child));
  ::close(ends[1]);
  if (!pid) {
    ::close(ends[0]);
    return refuse(reply, program + ": cannot be started: " + std::strerror(pid.error()));
  }
  pid_ = *pid;
  try {
    reader_ = std::thread(
        [this, output = ends[0], child_pid = *pid, reply] { await_end(output, child_pid, reply); });
  } catch (const std::system_error& error) {
    ::close(ends[0]);
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    pid_ = -1;
    refuse(reply, std::string("backup: no thread: ") + error.what());
  }
}

void BackupChild::await_end(int output, pid_t pid, const CommandReply& reply) {
  std::string text;
  bool is_left = false;
  while (read_output(output, text) && !is_left) is_left = is_given_up(pid);
  ::close(output);
  // The child stays a zombie until the mutex is held, so that no other process gets a signal.
  while (!is_left && !has_ended(pid)) {
    std::this_thread::sleep_for(kLook / 20);
    is_left = is_given_up(pid);
  }
  int status = 0;
  bool is_stopped = false;
  {
    const std::lock_guard lock(mutex_);
    ::waitpid(pid, &status, is_left ? WNOHANG : 0);
    pid_ = -1;
    is_stopped = is_stopped_;
  }
  if (is_stopped) return;
  while (text.ends_with('\n')) text.pop_back();
  const bool is_ok = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!is_ok && text.empty()) text = "backup: the program " + how_it_ended(status);
  reply(CommandAnswer::last(std::move(text), is_ok));
}

bool BackupChild::is_given_up(pid_t pid) {
  const std::lock_guard lock(mutex_);
  if (!is_stopped_) return false;
  const auto waited = std::chrono::steady_clock::now() - stopped_at_;
  if (!is_killed_ && waited >= patience_.terminate) {
    is_killed_ = true;
    ::kill(pid, SIGKILL);
  }
  return waited >= patience_.terminate + patience_.kill;
}

void BackupChild::ask_to_stop() {
  const std::lock_guard lock(mutex_);
  if (is_stopped_) return;
  is_stopped_ = true;
  stopped_at_ = std::chrono::steady_clock::now();
  if (pid_ >= 0) ::kill(pid_, SIGTERM);
}

void BackupChild::stop() {
  ask_to_stop();
  if (reader_.joinable()) reader_.join();
}

}  // namespace runstone
