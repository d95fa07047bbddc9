// ProgressLine: shows on standard error how far a long task is and how much time is left.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace runstone {

/// Returns a text such as "edits read: 512000 of 1000000, 12 s left". `first` is the value of
/// `done` at the start. The time left is estimated from the progress since `first`, and left out in
/// the first second.
std::string progress_text(const std::string& what, std::uint64_t first, std::uint64_t done,
                          std::uint64_t last, double seconds);

/// Shows nothing in the first second. After that, on a terminal, one line is rewritten twice a
/// second, and the destructor erases it. Elsewhere, a line is printed every two seconds, and only
/// if `always` is true. One thread.
class ProgressLine {
 public:
  ProgressLine(std::string what, bool always);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::uint64_t done, std::uint64_t last);

 private:
  using Clock = std::chrono::steady_clock;
  const std::string what_;
  const bool terminal_, always_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_ + std::chrono::seconds(1);
  std::uint64_t first_ = 0;
  bool has_first_ = false, is_shown_ = false;
};

}  // namespace runstone
