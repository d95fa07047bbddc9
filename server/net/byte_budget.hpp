// ByteBudget: a limit of bytes a second that sessions may share. A session that wants to send books
// the next free slot of time. Each session has at most one slot booked, so sessions with data
// alternate, and a session without data leaves no gap.
// Times are arguments (microseconds of one steady clock). Threads: any.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "common/core/ids.hpp"

namespace runstone {

class ByteBudget {
 public:
  /// 0 means no limit.
  explicit ByteBudget(std::uint64_t bytes_per_second)
      : per_second_(std::min(bytes_per_second, kPerSecondMax)) {}
  bool is_limited() const { return per_second_ != 0; }

  /// Books a slot for `bytes`. Returns the time from which they may be sent. The slot is used up
  /// even if nothing is sent.
  TimeUs book(std::size_t bytes, TimeUs now_us) {
    if (!is_limited()) return now_us;
    const std::lock_guard lock(mutex_);
    const std::int64_t from_ns = std::max(free_ns_, now_us * 1'000);
    free_ns_ = from_ns + span_ns(bytes);
    return from_ns / 1'000;
  }
  /// Counts bytes that were sent without a slot. They delay later slots, in all by at most
  /// kDebtUsMax, so that slots never stop.
  void charge(std::size_t bytes, TimeUs now_us) {
    if (!is_limited() || bytes == 0) return;
    const std::lock_guard lock(mutex_);
    const std::int64_t later_ns = std::max(free_ns_, now_us * 1'000) + span_ns(bytes);
    free_ns_ = std::max(free_ns_, std::min(later_ns, (now_us + kDebtUsMax) * 1'000));
  }

  static constexpr TimeUs kDebtUsMax = 250'000;

 private:
  static constexpr std::uint64_t kPerSecondMax = 1ULL << 50;
  std::int64_t span_ns(std::size_t bytes) const {
    return static_cast<std::int64_t>(static_cast<double>(bytes) * 1e9 /
                                     static_cast<double>(per_second_));
  }

  const std::uint64_t per_second_;
  std::mutex mutex_;
  std::int64_t free_ns_ = 0;
};

}  // namespace runstone
