#include "common/model_files/model_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "common/os/child_program.hpp"

namespace runstone {
namespace {

using Milliseconds = std::chrono::milliseconds;

constexpr std::size_t kBufferBytes = 256 * 1024;
constexpr std::size_t kErrorsBytesMax = 4096;
constexpr Milliseconds kStep{100};  // between two questions if the child is still wanted

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
}

}  // namespace

Result<ModelChild, std::string> ModelChild::start(const std::vector<std::string>& words,
                                                  Clock::time_point deadline,
                                                  std::function<bool()> should_continue) {
  std::array<int, 2> output{-1, -1}, errors{-1, -1};
  const bool has_pipes =
      ::pipe2(output.data(), O_CLOEXEC) == 0 && ::pipe2(errors.data(), O_CLOEXEC) == 0;
  int reason = errno;
  int pid = -1;
  if (has_pipes) {
    ::fcntl(output[0], F_SETPIPE_SZ, static_cast<int>(kBufferBytes));  // fewer turns; may fail
    for (const int end : {output[0], errors[0]}) ::fcntl(end, F_SETFL, O_NONBLOCK);
    ChildProgram program;
    program.words = words;
    program.out = output[1];
    program.errors = errors[1];
    const auto started = start_program(std::move(program));
    if (started) pid = *started;
    if (!started) reason = started.error();
  }
  close_if_open(output[1]);
  close_if_open(errors[1]);
  if (pid < 0) {
    close_if_open(output[0]);
    close_if_open(errors[0]);
    return failure(std::string(std::strerror(reason)));
  }
  return ModelChild(pid, output[0], errors[0], deadline, std::move(should_continue));
}

ModelChild::ModelChild(int pid, int output, int error_output, Clock::time_point deadline,
                       std::function<bool()> should_continue)
    : pid_(pid),
      output_(output),
      error_output_(error_output),
      deadline_(deadline),
      should_continue_(std::move(should_continue)),
      buffer_(kBufferBytes) {}

ModelChild::ModelChild(ModelChild&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      output_(std::exchange(other.output_, -1)),
      error_output_(std::exchange(other.error_output_, -1)),
      deadline_(other.deadline_),
      should_continue_(std::move(other.should_continue_)),
      buffer_(std::move(other.buffer_)),
      begin_(other.begin_),
      end_(other.end_),
      errors_(std::move(other.errors_)),
      status_(other.status_),
      stopped_(other.stopped_) {}

ModelChild::~ModelChild() {
  if (pid_ >= 0) {
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  close_if_open(output_);
  close_if_open(error_output_);
}

bool ModelChild::fill(std::span<std::uint8_t> to) {
  while (!to.empty()) {
    if (begin_ == end_ && !receive()) return false;
    const std::size_t some = std::min(to.size(), end_ - begin_);
    std::memcpy(to.data(), buffer_.data() + begin_, some);
    begin_ += some;
    to = to.subspan(some);
  }
  return true;
}

bool ModelChild::is_at_end() { return begin_ == end_ && !receive() && stopped_ == Stop::none; }

/// Waits for bytes of standard output and puts them into the buffer. Returns false if there are none.
bool ModelChild::receive() {
  while (output_ >= 0 && may_go_on()) {
    const auto left = std::chrono::duration_cast<Milliseconds>(deadline_ - Clock::now());
    const Milliseconds pause = std::clamp<Milliseconds>(left, Milliseconds(1), kStep);
    std::array<pollfd, 2> ready{{{output_, POLLIN, 0}, {error_output_, POLLIN, 0}}};
    if (::poll(ready.data(), ready.size(), static_cast<int>(pause.count())) <= 0) continue;
    if (ready[1].revents != 0) read_errors();
    if (ready[0].revents == 0) continue;
    const ssize_t got = ::read(output_, buffer_.data(), buffer_.size());
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (got <= 0) {
      close_if_open(output_);
      return false;
    }
    begin_ = 0;
    end_ = static_cast<std::size_t>(got);
    return true;
  }
  return false;
}

bool ModelChild::may_go_on() {
  if (stopped_ == Stop::none && Clock::now() >= deadline_) stopped_ = Stop::deadline;
  if (stopped_ == Stop::none && should_continue_ && !should_continue_()) stopped_ = Stop::unwanted;
  return stopped_ == Stop::none;
}

/// Reads what is there of standard error. What goes beyond the limit is read and dropped, so that the
/// child never waits.
void ModelChild::read_errors() {
  std::array<char, 1024> part;
  for (int turns = 0; error_output_ >= 0 && turns < 64; ++turns) {
    const ssize_t got = ::read(error_output_, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) return;
    if (got <= 0) return close_if_open(error_output_);
    errors_.append(part.data(),
                   std::min(static_cast<std::size_t>(got), kErrorsBytesMax - errors_.size()));
  }
}

int ModelChild::wait() {
  while (pid_ >= 0) {
    read_errors();
    const pid_t ended = ::waitpid(pid_, &status_, WNOHANG);
    if (ended < 0 && errno == EINTR) continue;
    if (ended != 0) {
      pid_ = -1;
      if (ended < 0) status_ = -1;
      break;
    }
    if (!may_go_on()) return -1;
    std::this_thread::sleep_for(Milliseconds(1));
  }
  read_errors();
  return status_;
}

}  // namespace runstone
