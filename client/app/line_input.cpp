#include "client/app/line_input.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include "common/core/text.hpp"
#include "common/os/text_file.hpp"
#include "protocol/limits.hpp"

namespace runstone {

LineInput::LineInput(int descriptor) : descriptor_(descriptor) {
  // Without this, a read of the terminal from the background would stop the process.
  std::signal(SIGTTIN, SIG_IGN);
}

std::vector<std::string> LineInput::take_lines() {
  std::vector<std::string> lines;
  pollfd input{descriptor_, POLLIN, 0};
  if (descriptor_ < 0 || ::poll(&input, 1, 0) <= 0) return lines;
  std::array<char, 4'096> bytes{};
  const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
  if (count > 0) take({bytes.data(), static_cast<std::size_t>(count)}, lines);
  if (count > 0 || (count < 0 && (errno == EINTR || errno == EAGAIN))) return lines;
  // EIO: the terminal is closed, or this process is in its background and may come back.
  const bool is_in_background = count < 0 && errno == EIO && ::tcgetpgrp(descriptor_) > 0 &&
                                ::tcgetpgrp(descriptor_) != ::getpgrp();
  if (!is_in_background) descriptor_ = -1;
  return lines;
}

void LineInput::take(std::string_view bytes, std::vector<std::string>& lines) {
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    line_ += bytes.substr(0, end);
    if (line_.size() > kCommandBytesMax) line_.resize(kCommandBytesMax);
    if (end == bytes.size()) return;
    bytes.remove_prefix(end + 1);
    trim_line(line_);
    lines.push_back(std::exchange(line_, {}));
  }
}

}  // namespace runstone
