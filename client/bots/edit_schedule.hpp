// EditSchedule: when the edits of a bot are due. Open loop: edit i is due (i + phase) / rate
// seconds after the start, whatever became of the edits before. Pure. One thread.
#pragma once
#include <cstdint>
#include <optional>

#include "common/core/ids.hpp"

namespace runstone {

class EditSchedule {
 public:
  /// `rate`: edits per second, > 0. `phase`: 0 to 1, so that the bots of a fleet do not act at the
  /// same instant.
  EditSchedule(double rate, double phase, std::optional<std::uint64_t> count_max)
      : rate_(rate), phase_(phase), count_max_(count_max) {}

  void begin(TimeUs now_us) { began_us_ = now_us; }
  void end() { is_ended_ = true; }
  std::optional<TimeUs> began_us() const { return began_us_; }
  /// Returns true if nothing is due any more.
  bool is_over() const { return is_ended_ || (count_max_ && count_ >= *count_max_); }
  /// Returns when the next edit is due, or nullopt before the start and after the end.
  std::optional<TimeUs> due_us() const {
    if (!began_us_ || is_over()) return std::nullopt;
    return *began_us_ + static_cast<TimeUs>((static_cast<double>(count_) + phase_) / rate_ * 1e6);
  }
  /// Counts the next edit as done.
  void pass() { ++count_; }

 private:
  double rate_, phase_;
  std::optional<std::uint64_t> count_max_;
  std::optional<TimeUs> began_us_;
  bool is_ended_ = false;
  std::uint64_t count_ = 0;
};

}  // namespace runstone
