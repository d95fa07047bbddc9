// ProgressLine: how far long work is and how long it will still take, on stderr, for whoever watches.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace runstone {

/// "edits read: 512000 of 1000000, 12 s left". `first`: where the work began, for the time left; without that before 1 s.
std::string progress_text(const std::string& what, std::uint64_t first, std::uint64_t done,
                          std::uint64_t last, double seconds);

/// Silent for the first second. Then, on a terminal, a line that rewrites itself twice a second and goes with the object;
/// elsewhere, only if `always`, a line every two seconds. One thread.
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
