// FleetStatistics: what all bots of one process share: when their edits were due, how the ground
// was, and how soon each bot received each edit. One thread.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/bots/due_times.hpp"
#include "client/bots/shared_ground.hpp"
#include "client/schedule/histogram.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// The number of seconds for each of which the slowest edit is recorded.
inline constexpr std::size_t kWorstSecondsMax = 3'600;

class FleetStatistics {
 public:
  DueTimes due;
  SharedGround ground;

  /// Starts the count of seconds.
  void begin(TimeUs now_us) { began_us_ = now_us; }
  /// A bot received and verified an edit that was due at `due_us`.
  void see(TimeUs due_us, TimeUs seen_us) {
    seen_us_.add(seen_us - due_us);
    if (due_us < began_us_) return;
    const auto second = static_cast<std::size_t>((due_us - began_us_) / 1'000'000);
    if (second >= kWorstSecondsMax) return;
    if (worst_us_.size() <= second) worst_us_.resize(second + 1);
    worst_us_[second] = std::max(worst_us_[second], seen_us - due_us);
  }
  /// A bot received an edit that no bot of this process made, or that is too old for DueTimes.
  void see_unknown() { ++unattributed_; }

  /// Returns the times from due to verified, one per edit and bot that received it.
  const Histogram& seen_us() const { return seen_us_; }
  /// Returns, by second, the time of the slowest edit that was due in it.
  const std::vector<TimeUs>& worst_us() const { return worst_us_; }
  std::uint64_t unattributed() const { return unattributed_; }

 private:
  TimeUs began_us_ = 0;
  Histogram seen_us_;
  std::vector<TimeUs> worst_us_;
  std::uint64_t unattributed_ = 0;
};

}  // namespace runstone
