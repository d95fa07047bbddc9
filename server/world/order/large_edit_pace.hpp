// LargeEditPace: computes how much of the players' large edits the next commit may send. One paste
// of 48 KB in front of 40 players is 2 MB to send, and it costs each of these players the time to
// apply it. A budget that was saved up pays for several of them at once, and attackers have many
// keys. So the work of large edits (edit_work()), times the sessions that see them, is at most
// kPerSecond. Large edits beyond it wait in EditQueue, and small edits of other clients overtake
// them. Method: a balance of time grows with the clock. What is sent costs the time that it takes
// at kPerSecond. Large edits are ordered while the balance is above zero. Pure: times are arguments
// (microseconds of one steady clock). One thread.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

class LargeEditPace {
 public:
  static constexpr std::uint64_t kPerSecond = 4 * 1024 * 1024;
  /// The balance that is kept for a burst: 4 MiB of work.
  static constexpr TimeUs kSavedUsMax = 1'000'000;
  /// One large edit that very many see keeps others waiting no longer than this.
  static constexpr TimeUs kDebtUsMax = 1'000'000;

  /// Returns the work that the large edits of a commit may have now, over all sessions. At 0 all
  /// of them wait. The last edit that begins within the bound may exceed it.
  std::uint64_t room(TimeUs now_us) const {
    const TimeUs balance = std::clamp<TimeUs>(now_us - zero_us_, 0, kSavedUsMax);
    return static_cast<std::uint64_t>(balance) * kPerSecond / 1'000'000;
  }
  /// Takes the work of large edits that are sent, over all sessions.
  void charge(std::uint64_t work, TimeUs now_us) {
    const auto cost_us = static_cast<TimeUs>(work * 1'000'000 / kPerSecond);
    zero_us_ = std::min(std::max(zero_us_, now_us - kSavedUsMax) + cost_us, now_us + kDebtUsMax);
  }

 private:
  TimeUs zero_us_ = -kSavedUsMax;  // when the balance is or was zero, if nothing more is sent
};

}  // namespace runstone
