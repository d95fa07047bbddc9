// DurableLag: how long ordered edits wait until they are on disk. It learns of edits when it is
// called, and takes those that were ordered since the call before as ordered in this moment.
// Thread: the world strand. Memory: bounded by kMarksMax.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/core/ids.hpp"
#include "server/world/order/wait_histogram.hpp"

namespace runstone {

class DurableLag {
 public:
  /// The number of groups of edits that may wait. With more, a later group counts as ordered with
  /// the last one, so that its wait is reported too long, never too short.
  static constexpr std::size_t kMarksMax = 4'096;

  /// Notes the last edit that was ordered, and the last one that is on disk. `now_us` is of the
  /// steady clock. The edits before the first call count as on disk. If `head` falls, because
  /// another server owns the world, all waits are dropped. Cost: O(1) amortised.
  void observe(Sequence head, Sequence durable, TimeUs now_us);
  /// Returns the age of the oldest edit that is not on disk, or 0 if there is none.
  TimeUs lag_us(TimeUs now_us) const;
  /// Returns the waits of the edits that are on disk, one for each edit.
  const WaitHistogram& waits() const { return waits_; }

 private:
  struct Mark {
    Sequence last = 0;  // of the edits that were ordered together
    std::uint64_t edits = 0;
    TimeUs ordered_us = 0;
  };
  std::deque<Mark> marks_;  // not on disk, ascending
  Sequence head_ = 0;
  bool has_begun_ = false;
  WaitHistogram waits_;
};

}  // namespace runstone
