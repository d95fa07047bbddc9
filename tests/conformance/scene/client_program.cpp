#include "tests/conformance/scene/client_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "common/os/child_program.hpp"

namespace runstone::conformance {
namespace {

/// The longest line of a client that is kept. What is longer has no meaning.
constexpr std::size_t kLineBytesMax = 64 * 1024;

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  return ends;
}

}  // namespace

ClientProgram::ClientProgram(std::vector<std::string> words, int errors) {
  const auto [in_read, in_write] = make_pipe();
  const auto [out_read, out_write] = make_pipe();
  in_ = in_write;
  out_ = out_read;
  const std::string name = words.front();
  const auto started = start_program({std::move(words), in_read, out_write, {}, errors});
  ::close(in_read);
  ::close(out_write);
  if (!started) {
    ::close(in_);
    ::close(out_);
    throw std::system_error(started.error(), std::generic_category(), "cannot start " + name);
  }
  pid_ = *started;
  ::fcntl(out_, F_SETFL, O_NONBLOCK);
}

ClientProgram::~ClientProgram() {
  ::close(in_);
  ::close(out_);
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void ClientProgram::write_line(const std::string& line) {
  const std::string text = line + "\n";
  // A program that does not read its lines fails its scene: it does not answer.
  [[maybe_unused]] const ssize_t written = ::write(in_, text.data(), text.size());
}

std::optional<std::string> ClientProgram::next() {
  std::array<char, 16 * 1024> buffer{};
  if (lines_.empty() && !is_ended_) {
    const ssize_t got = ::read(out_, buffer.data(), buffer.size());
    is_ended_ = got == 0;
    const auto bytes = static_cast<std::size_t>(std::max<ssize_t>(got, 0));
    for (const char c : std::string_view(buffer.data(), bytes)) {
      if (c == '\n') {
        lines_.push_back(std::exchange(text_, {}));
      } else if (text_.size() < kLineBytesMax) {
        text_ += c;
      }
    }
  }
  if (lines_.empty()) return std::nullopt;
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

}  // namespace runstone::conformance
