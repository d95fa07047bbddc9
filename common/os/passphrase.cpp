#include "common/os/passphrase.hpp"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

namespace runstone {
namespace {

/// The terminal of the process, also when standard input and output are files.
class Terminal {
 public:
  Terminal() : fd_(::open("/dev/tty", O_RDWR | O_CLOEXEC)) {
    if (fd_ < 0 || ::tcgetattr(fd_, &shown_) != 0) return;
    termios hidden = shown_;
    hidden.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    hidden.c_lflag |= ECHONL;
    is_hidden_ = ::tcsetattr(fd_, TCSAFLUSH, &hidden) == 0;
  }
  ~Terminal() {
    if (is_hidden_) ::tcsetattr(fd_, TCSAFLUSH, &shown_);
    if (fd_ >= 0) ::close(fd_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  bool is_hidden() const { return is_hidden_; }
  bool print(const std::string& text) const {
    return ::write(fd_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  }
  bool read_line(std::string& line) const {
    for (char c = 0; ::read(fd_, &c, 1) == 1; line += c) {
      if (c == '\n') return true;
    }
    return false;
  }

 private:
  int fd_ = -1;
  termios shown_{};
  bool is_hidden_ = false;
};

}  // namespace

Result<std::string, std::string> ask_passphrase(const std::string& prompt) {
  const Terminal terminal;
  if (!terminal.is_hidden() || !terminal.print(prompt))
    return failure("there is no terminal to ask for the passphrase");
  std::string line;
  if (!terminal.read_line(line)) return failure("no passphrase was typed");
  return line;
}

Result<std::string, std::string> ask_new_passphrase(const std::string& prompt) {
  auto first = ask_passphrase(prompt);
  if (!first) return first;
  const auto second = ask_passphrase("again: ");
  if (!second) return second;
  if (*first != *second) return failure("the two lines differ");
  return first;
}

}  // namespace runstone
