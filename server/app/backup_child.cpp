#include "server/app/backup_child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/os/child_program.hpp"

namespace runstone {

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
  reader_ = std::thread([this, output = ends[0], child_pid = *pid, reply = std::move(reply)] {
    await_end(output, child_pid, reply);
  });
}

void BackupChild::await_end(int output, pid_t pid, const CommandReply& reply) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t bytes = ::read(output, part.data(), part.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(bytes));
  }
  ::close(output);
  siginfo_t ended{};
  // The child stays a zombie until the mutex is held, so that stop() never signals another process.
  while (::waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  int status = 0;
  bool is_stopped = false;
  {
    const std::lock_guard lock(mutex_);
    ::waitpid(pid, &status, 0);
    pid_ = -1;
    is_stopped = is_stopped_;
  }
  if (is_stopped) return;
  while (text.ends_with('\n')) text.pop_back();
  const bool is_ok = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!is_ok && text.empty()) text = "backup: the program " + how_it_ended(status);
  reply(CommandAnswer::last(std::move(text), is_ok));
}

void BackupChild::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    if (pid_ >= 0) ::kill(pid_, SIGTERM);
  }
  if (reader_.joinable()) reader_.join();
}

}  // namespace runstone
