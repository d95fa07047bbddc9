#include "common/os/progress_line.hpp"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace runstone {

std::string progress_text(const std::string& what, std::uint64_t first, std::uint64_t done,
                          std::uint64_t last, double seconds) {
  std::string text = what + ": " + std::to_string(done) + " of " + std::to_string(last);
  if (done <= first || done > last || seconds < 1) return text;
  const double left =
      seconds * static_cast<double>(last - done) / static_cast<double>(done - first);
  const auto whole = static_cast<std::uint64_t>(left + 0.5);
  if (whole < 120) return text + ", " + std::to_string(whole) + " s left";
  return text + ", " + std::to_string((whole + 30) / 60) + " min left";
}

ProgressLine::ProgressLine(std::string what, bool always)
    : what_(std::move(what)), terminal_(::isatty(STDERR_FILENO) == 1), always_(always) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && is_shown_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::show(std::uint64_t done, std::uint64_t last) {
  if (!std::exchange(has_first_, true)) first_ = done;
  if (!terminal_ && !always_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(terminal_ ? 500 : 2000);
  is_shown_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const std::string text = progress_text(what_, first_, done, last, seconds);
  std::fprintf(stderr, terminal_ ? "\r%s\033[K" : "%s\n", text.c_str());
  std::fflush(stderr);
}

}  // namespace runstone
