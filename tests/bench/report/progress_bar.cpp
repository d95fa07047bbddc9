#include "tests/bench/report/progress_bar.hpp"

#include <fmt/ostream.h>

#include <cmath>

namespace runstone::bench {
namespace {

constexpr std::size_t kBarWidth = 24;

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<long>(std::lround(seconds / 60));
  return minutes < 100 ? fmt::format("{} min", minutes)
                       : fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

ProgressBar::ProgressBar(std::ostream& out, bool is_terminal, std::size_t steps,
                         double expected_seconds)
    : out_(out), is_terminal_(is_terminal), steps_(steps), expected_left_(expected_seconds) {}

void ProgressBar::begin(const std::string& step) {
  step_ = step;
  if (is_terminal_) draw(step);
}

void ProgressBar::end(const std::string& how, double expected_seconds, double took_seconds) {
  ++done_;
  expected_left_ -= expected_seconds;
  if (took_seconds > 0) {
    expected_done_ += expected_seconds;
    took_ += took_seconds;
  }
  if (is_terminal_) {
    fmt::print(out_, "\r\x1b[K{:24} {}\n", step_, how);
    if (done_ < steps_) draw("");
  } else {
    fmt::print(out_, "[{}/{}] {:24} {}{}\n", done_, steps_, step_, how,
               done_ < steps_ ? "; about " + left() + " left" : "");
  }
  out_.flush();
}

std::string ProgressBar::left() const {
  // The speed of this machine relative to the one that gave the expected times, from the steps so
  // far.
  const double pace = expected_done_ > 0 ? took_ / expected_done_ : 1;
  return duration_text(expected_left_ * pace);
}

void ProgressBar::draw(const std::string& what) const {
  const std::size_t filled = kBarWidth * done_ / steps_;
  fmt::print(out_, "\r\x1b[K[{}{}] {}/{}  about {} left  {}", std::string(filled, '#'),
             std::string(kBarWidth - filled, '.'), done_, steps_, left(), what);
  out_.flush();
}

}  // namespace runstone::bench
