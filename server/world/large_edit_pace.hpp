// LargeEditPace: computes how much of large edits the next commit may send. One paste of 48 KB in
// front of 40 players is 2 MB to send, and it costs each of these players the time to apply it. A
// budget of edits that was saved up pays for a hundred of them at once. So all sessions together
// get at most kPerSecond bytes of large edits a second. Large edits beyond it wait in EditQueue,
// and small edits of other clients overtake them.
// Method: a balance of time grows with the clock. What is sent costs the time that it takes at
// kPerSecond. Large edits are ordered while the balance is above zero.
// Pure: times are arguments (microseconds of one steady clock). One thread.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

class LargeEditPace {
 public:
  static constexpr std::uint64_t kPerSecond = 4 * 1024 * 1024;
  /// The balance that is kept for a burst: 1.3 MB.
  static constexpr TimeUs kSavedUsMax = 1'000'000;
  /// One large edit that very many see keeps others waiting no longer than this.
  static constexpr TimeUs kDebtUsMax = 1'000'000;

  /// Returns the bytes that the large edits of a commit may send now, over all sessions. At 0 all
  /// of them wait. The last edit that begins within the bound may exceed it.
  std::uint64_t room(TimeUs now_us) const {
    const TimeUs balance = std::clamp<TimeUs>(now_us - zero_us_, 0, kSavedUsMax);
    return static_cast<std::uint64_t>(balance) * kPerSecond / 1'000'000;
  }
  /// Counts bytes of large edits that were sent, over all sessions.
  void sent(std::uint64_t bytes, TimeUs now_us) {
    const auto cost_us = static_cast<TimeUs>(bytes * 1'000'000 / kPerSecond);
    zero_us_ = std::min(std::max(zero_us_, now_us - kSavedUsMax) + cost_us, now_us + kDebtUsMax);
  }

 private:
  TimeUs zero_us_ = -kSavedUsMax;  // when the balance is or was zero, if nothing more is sent
};

}  // namespace runstone
