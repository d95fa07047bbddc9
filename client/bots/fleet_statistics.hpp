// FleetStatistics: what all bots of one process share: when their edits were due, what the ground was like, and how soon each edit
// was seen by each bot that got it. One thread.
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

inline constexpr std::size_t kWorstSecondsMax = 3'600;  // of which the slowest edit is kept

class FleetStatistics {
 public:
  DueTimes due;
  SharedGround ground;

  /// Seconds are counted from here.
  void begin(TimeUs now_us) { began_us_ = now_us; }
  /// A bot has received and verified an edit that was due then.
  void see(TimeUs due_us, TimeUs seen_us) {
    seen_us_.add(seen_us - due_us);
    if (due_us < began_us_) return;
    const auto second = static_cast<std::size_t>((due_us - began_us_) / 1'000'000);
    if (second >= kWorstSecondsMax) return;
    if (worst_us_.size() <= second) worst_us_.resize(second + 1);
    worst_us_[second] = std::max(worst_us_[second], seen_us - due_us);
  }
  /// A bot has received an edit that none of this process made, or that is too old to be known.
  void see_unknown() { ++unattributed_; }

  /// Due to received and verified, each edit at each bot that got its commit.
  const Histogram& seen_us() const { return seen_us_; }
  /// The slowest of the edits that were due in each second.
  const std::vector<TimeUs>& worst_us() const { return worst_us_; }
  std::uint64_t unattributed() const { return unattributed_; }

 private:
  TimeUs began_us_ = 0;
  Histogram seen_us_;
  std::vector<TimeUs> worst_us_;
  std::uint64_t unattributed_ = 0;
};

}  // namespace runstone
