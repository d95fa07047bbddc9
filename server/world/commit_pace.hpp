// CommitPace: when the edits that wait become a commit. Alone or in small company at once: an edit waits for nobody. In
// a crowd each commit is a send call per receiver, and a thousand receivers times a hundred commits a second are more
// calls than two cores can make; so while sending commits takes more than half of one core, edits gather, up to
// kGatherUsMax. Terrain does not count: it never delays a commit.
// How: time to send with comes back at kSendShare of the clock; what commits took is drawn from it; a commit waits
// until nothing is owed. Pure: times are arguments (microseconds of a steady clock). One thread.
#pragma once
#include <algorithm>

#include "common/core/ids.hpp"

namespace runstone {

class CommitPace {
 public:
  static constexpr TimeUs kGatherUsMax = 25'000;  // no edit waits longer for others
  static constexpr TimeUs kSavedUsMax = 5'000;    // sending time saved up in calm moments, for a burst
  static constexpr TimeUs kPerSendingUs = 2;      // half a core: two microseconds pay for one of sending

  /// An edit has come and none waited: when to commit, `now_us` at the earliest and kGatherUsMax later at the latest.
  /// `sending_us`: what sending commits has taken since the start, all sessions together; never decreases.
  TimeUs due(TimeUs now_us, TimeUs sending_us) {
    const TimeUs passed = std::max<TimeUs>(now_us - last_us_, 0);
    const TimeUs spent = sending_us - last_sending_us_;
    last_us_ = std::max(last_us_, now_us);
    last_sending_us_ = sending_us;
    // Debt is bounded too: after a stall the next commits gather for a while, not for ever.
    saved_ = std::clamp(saved_ + passed - kPerSendingUs * spent, -kDebtMax, kPerSendingUs * kSavedUsMax);
    return now_us + std::clamp<TimeUs>(-saved_, 0, kGatherUsMax);
  }

 private:
  static constexpr TimeUs kDebtMax = 4 * kGatherUsMax;
  TimeUs last_us_ = 0, last_sending_us_ = 0;
  TimeUs saved_ = 0;  // microseconds of the clock; negative: owed
};

}  // namespace runstone
