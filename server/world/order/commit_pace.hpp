// CommitPace: computes when queued edits become a commit. With few players an edit never waits.
// With many players each commit costs one send call per receiver, and a thousand receivers times a
// hundred commits a second are more calls than two cores can make. So while sending commits takes
// more than half of one core, edits gather for up to kGatherUsMax. Sending terrain does not count
// and never delays a commit.
// Method: a balance of time grows with the clock. A microsecond of sending costs kPerSendingUs of
// it. Calls that are still to be made for queued commits are estimated and cost the same. A commit
// waits until the balance is not negative.
// Pure: times are arguments (microseconds of one steady clock). One thread.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

/// The cost of sending commits, all sessions together.
struct CommitSending {
  TimeUs spent_us = 0;      // since the start; never decreases
  std::uint64_t calls = 0;  // made in that time
  std::uint64_t due = 0;    // still to be made for queued commits
};

class CommitPace {
 public:
  /// No commit waits longer.
  static constexpr TimeUs kGatherUsMax = 25'000;
  /// Sending time that may be saved for a burst.
  static constexpr TimeUs kSavedUsMax = 5'000;
  /// Two microseconds of the clock pay for one of sending: half a core.
  static constexpr TimeUs kPerSendingUs = 2;
  /// The assumed cost of a call before the first one.
  static constexpr TimeUs kCallUsFirst = 10;

  /// Returns the time of the next commit, between `now_us` and `now_us` + kGatherUsMax. Call it
  /// when an edit is queued and no commit is scheduled.
  TimeUs due(TimeUs now_us, const CommitSending& sending) {
    const TimeUs passed = std::max<TimeUs>(now_us - last_us_, 0);
    const TimeUs spent = sending.spent_us - last_spent_us_;
    last_us_ = std::max(last_us_, now_us);
    last_spent_us_ = sending.spent_us;
    // The debt is bounded, so that after a stall commits are delayed for a short time only.
    saved_ =
        std::clamp(saved_ + passed - kPerSendingUs * spent, -kDebtMax, kPerSendingUs * kSavedUsMax);
    const TimeUs call_us = sending.calls == 0
                               ? kCallUsFirst
                               : sending.spent_us / static_cast<TimeUs>(sending.calls) + 1;
    const TimeUs to_spend = static_cast<TimeUs>(sending.due) * call_us;
    return now_us + std::clamp<TimeUs>(kPerSendingUs * to_spend - saved_, 0, kGatherUsMax);
  }

 private:
  static constexpr TimeUs kDebtMax = 4 * kGatherUsMax;
  TimeUs last_us_ = 0, last_spent_us_ = 0;
  TimeUs saved_ = 0;  // the balance, in microseconds of the clock; negative: debt
};

}  // namespace runstone
