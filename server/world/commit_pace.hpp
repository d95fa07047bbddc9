// CommitPace: when the edits that wait become a commit. Alone or in small company at once: an edit waits for nobody. In
// a crowd each commit is a send call per receiver, and a thousand receivers times a hundred commits a second are more
// calls than two cores can make; so while sending commits takes more than half of one core, edits gather, up to
// kGatherUsMax. Terrain does not count: it never delays a commit.
// How: time to send with comes back at half of the clock's; what sending took is drawn from it, and what it will take
// for receivers that have a commit and whose turn to send has not come; a commit waits until nothing is owed. Pure:
// times are arguments (microseconds of a steady clock). One thread.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

/// What sending commits costs, all sessions together.
struct CommitSending {
  TimeUs spent_us = 0;      // since the start; never decreases
  std::uint64_t calls = 0;  // that took it
  std::uint64_t due = 0;    // calls still to be made for commits that are queued
};

class CommitPace {
 public:
  static constexpr TimeUs kGatherUsMax = 25'000;  // no edit waits longer for others
  static constexpr TimeUs kSavedUsMax =
      5'000;  // sending time saved up in calm moments, for a burst
  static constexpr TimeUs kPerSendingUs =
      2;  // half a core: two microseconds pay for one of sending
  static constexpr TimeUs kCallUsFirst = 10;  // what a call is taken to cost before one was made

  /// An edit has come and none waited: when to commit, `now_us` at the earliest and kGatherUsMax later at the latest.
  TimeUs due(TimeUs now_us, const CommitSending& sending) {
    const TimeUs passed = std::max<TimeUs>(now_us - last_us_, 0);
    const TimeUs spent = sending.spent_us - last_spent_us_;
    last_us_ = std::max(last_us_, now_us);
    last_spent_us_ = sending.spent_us;
    // Debt is bounded too: after a stall the next commits gather for a while, not for ever.
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
  TimeUs saved_ = 0;  // microseconds of the clock; negative: owed
};

}  // namespace runstone
