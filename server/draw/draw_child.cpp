#include "server/draw/draw_child.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "common/os/child_program.hpp"

namespace runstone {
namespace {

using Milliseconds = std::chrono::milliseconds;

constexpr std::size_t kOrdersKept = 64 * 1024;  // small orders are sent together
constexpr Milliseconds kEndLimit{10'000};       // for the exit of a child without orders

}  // namespace

DrawChild::DrawChild(std::string program, int pid, int socket, const DrawChildOptions& options)
    : program_(std::move(program)),
      pid_(pid),
      socket_(socket),
      answer_limit_(options.answer_limit),
      should_continue_(options.should_continue) {}

DrawChild::DrawChild(DrawChild&& other) noexcept
    : program_(std::move(other.program_)),
      renderer_(std::move(other.renderer_)),
      pid_(std::exchange(other.pid_, -1)),
      socket_(std::exchange(other.socket_, -1)),
      answer_limit_(other.answer_limit_),
      should_continue_(std::move(other.should_continue_)),
      orders_(std::move(other.orders_)),
      lines_(std::move(other.lines_)),
      broken_(std::exchange(other.broken_, "moved away")) {}

DrawChild& DrawChild::operator=(DrawChild&& other) noexcept {
  if (this == &other) return *this;
  close_and_kill();
  program_ = std::move(other.program_);
  renderer_ = std::move(other.renderer_);
  pid_ = std::exchange(other.pid_, -1);
  socket_ = std::exchange(other.socket_, -1);
  answer_limit_ = other.answer_limit_;
  should_continue_ = std::move(other.should_continue_);
  orders_ = std::move(other.orders_);
  lines_ = std::move(other.lines_);
  broken_ = std::exchange(other.broken_, "moved away");
  return *this;
}

DrawChild::~DrawChild() { close_and_kill(); }

void DrawChild::close_and_kill() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

DrawChild::Outcome<DrawChild> DrawChild::start(const DrawChildOptions& options) {
  const std::string program =
      sibling_program(options.program, "RUNSTONE_CLIENT", "runstone-client");
  // A pair of sockets is used instead of two pipes, because a write to a closed socket can return
  // an error instead of raising a signal.
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return failure(program + ": no pair of sockets: " + std::strerror(errno));
  }
  const auto pid = start_program({{program, "--draw"}, ends[1], ends[1], ""});
  ::close(ends[1]);
  if (!pid) {
    ::close(ends[0]);
    return failure(
        program + ": cannot be started: " + std::strerror(pid.error()) +
        "; pictures need runstone-client (--client PATH or RUNSTONE_CLIENT says where it is)");
  }
  DrawChild child(program, *pid, ends[0], options);
  const auto answer = child.await_answer();
  if (!answer) return failure(answer.error());
  if (const auto* failed = std::get_if<DrawFailed>(&*answer)) return child.lost(failed->text);
  const auto* ready = std::get_if<DrawReady>(&*answer);
  if (ready == nullptr || ready->version != kDrawVersion) {
    return child.lost("is of another version of Runstone: both programs must be of one build");
  }
  child.renderer_ = ready->renderer;
  return child;
}

DrawChild::Outcome<void> DrawChild::world(std::int32_t edge, const MaterialTable& materials) {
  append_draw_world(edge, materials, orders_);
  return send();
}

DrawChild::Outcome<void> DrawChild::chunk(const ChunkKey& key, const RunChunk& voxels) {
  append_draw_chunk(key, voxels, orders_);
  return orders_.size() < kOrdersKept && broken_.empty() ? Outcome<void>{} : send();
}

DrawChild::Outcome<void> DrawChild::forget(const ChunkKey& key) {
  append_draw_forget(key, orders_);
  return orders_.size() < kOrdersKept && broken_.empty() ? Outcome<void>{} : send();
}

DrawChild::Outcome<PictureDrawn> DrawChild::draw(const DrawCamera& camera, PictureSize size,
                                                 const std::string& file) {
  const DrawPicture picture{camera, size, file};
  if (const auto sound = validate(picture); !sound)
    return failure(file + ": " + sound.error().what);
  append_draw_picture(picture, orders_);
  if (const auto sent = send(); !sent) return failure(sent.error());
  auto answer = await_answer();
  if (!answer) return failure(answer.error());
  if (const auto* failed = std::get_if<DrawFailed>(&*answer)) return lost(failed->text);
  if (auto* unwritten = std::get_if<PictureUnwritten>(&*answer))
    return failure(std::move(unwritten->text));
  auto* drawn = std::get_if<PictureDrawn>(&*answer);
  if (drawn == nullptr || drawn->file != file) return lost("sent an answer to another order");
  return std::move(*drawn);
}

DrawChild::Outcome<void> DrawChild::finish() {
  append_draw_end(orders_);
  if (const auto sent = send(); !sent) return sent;
  ::shutdown(socket_, SHUT_WR);
  const std::string ended = reap();
  broken_ = program_ + ": has finished";
  if (ended != how_it_ended(0)) return failure(program_ + ": " + ended);
  return {};
}

/// Sends all waiting orders. Meanwhile the child sends no answer, except the reason why it fails.
DrawChild::Outcome<void> DrawChild::send() {
  if (!broken_.empty()) {
    orders_.clear();
    return failure(broken_);
  }
  ByteView left(orders_);
  while (!left.empty()) {
    const ssize_t sent = ::send(socket_, left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      left = left.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) {
      // The child has closed the socket. Its last answer, if it sent one, has the reason.
      const auto answer = await_answer();
      if (!answer) return failure(answer.error());
      const auto* failed = std::get_if<DrawFailed>(&*answer);
      return lost(failed != nullptr ? failed->text : "gave up");
    }
    if (const auto ready = wait_for(POLLOUT); !ready) return ready;
  }
  orders_.clear();
  if (orders_.capacity() > 4 * kOrdersKept) Bytes().swap(orders_);
  return {};
}

/// Waits for the next answer. Fails if the child exits without one, or sends no valid answer.
DrawChild::Outcome<DrawAnswer> DrawChild::await_answer() {
  if (!broken_.empty()) return failure(broken_);
  for (;;) {
    const std::size_t end = lines_.find('\n');
    if (end != std::string::npos) {
      auto answer = parse_draw_answer(std::string_view(lines_).substr(0, end));
      if (!answer)
        return lost("is no program that draws: it answered \"" + lines_.substr(0, end) + "\"");
      lines_.erase(0, end + 1);
      return *std::move(answer);
    }
    if (lines_.size() >= kDrawAnswerBytesMax)
      return lost("is no program that draws: its answer has no end");
    if (const auto ready = wait_for(POLLIN); !ready) return failure(ready.error());
    const auto more = receive();
    if (!more) return failure(more.error());
    if (!*more) return lost("");
  }
}

/// Waits until one of the events of poll() is possible on the socket.
DrawChild::Outcome<void> DrawChild::wait_for(short events) {
  const auto end = std::chrono::steady_clock::now() + answer_limit_;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<Milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) {
      return lost("did nothing for " + std::to_string(answer_limit_.count() / 1000) +
                  " s and was stopped");
    }
    if (should_continue_ && !should_continue_()) return lost("is not wanted any more");
    pollfd poll{socket_, events, 0};
    // The wait has steps of at most a second, because the limit may not fit into an int, and
    // because the child may be wanted no longer.
    const int count =
        ::poll(&poll, 1, static_cast<int>(std::min<Milliseconds::rep>(left.count(), 1000)));
    if (count > 0) return {};
    if (count < 0 && errno != EINTR)
      return lost(std::string("cannot be waited for: ") + std::strerror(errno));
  }
}

/// Receives what is there. Returns false at the end of the stream.
DrawChild::Outcome<bool> DrawChild::receive() {
  std::array<char, 4096> buffer;
  const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return true;
  // A child that exits with unread orders resets the connection instead of ending the stream.
  if (got <= 0) return false;
  lines_.append(buffer.data(), static_cast<std::size_t>(got));
  return true;
}

/// Ends the child and returns the error for this call and all later ones. If `why` is empty, the
/// child exits by itself and its exit status is the reason.
Unexpected<std::string> DrawChild::lost(const std::string& why) {
  broken_ = program_ + ": " + (why.empty() ? reap() : why);
  close_and_kill();
  orders_.clear();
  return failure(broken_);
}

/// Waits for the exit of a child that has no more orders. Returns a text about its exit status.
std::string DrawChild::reap() {
  const auto end = std::chrono::steady_clock::now() + kEndLimit;
  int status = 0;
  for (;;) {
    const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) break;
    if (ended < 0 && errno != EINTR) return "is no longer a child process";
    if (std::chrono::steady_clock::now() > end) {
      close_and_kill();
      return "did not end and was stopped";
    }
    std::this_thread::sleep_for(Milliseconds(2));
  }
  pid_ = -1;
  return how_it_ended(status);
}

}  // namespace runstone
