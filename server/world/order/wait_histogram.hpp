// WaitHistogram: how many edits waited how long on the server: from the moment in which the world
// strand handled the request to the moment in which it ordered the edit, whose commit is then sent
// at once. The network's time is not in it. At a server that follows the owner of the world, an
// edit waits until the owner's answer has arrived, so the time between the servers is in it.
// Thread: the world strand.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

class WaitHistogram {
 public:
  /// The upper bounds of the buckets, in milliseconds. A last bucket has no bound.
  static constexpr std::array<std::uint32_t, 10> kBoundsMs = {1,  2,   5,   10,  20,
                                                              50, 100, 200, 500, 1000};

  /// Adds `count` edits that waited so long.
  void add(TimeUs wait_us, std::uint64_t count = 1) {
    std::size_t bucket = 0;
    while (bucket < kBoundsMs.size() && wait_us > TimeUs{kBoundsMs[bucket]} * 1000) ++bucket;
    buckets_[bucket] += count;
    count_ += count;
    sum_us_ += wait_us * static_cast<TimeUs>(count);
  }
  /// Returns the number of waits that were not longer than kBoundsMs[bucket].
  std::uint64_t at_most(std::size_t bucket) const {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i <= bucket; ++i) out += buckets_[i];
    return out;
  }
  std::uint64_t count() const { return count_; }
  TimeUs sum_us() const { return sum_us_; }

 private:
  std::array<std::uint64_t, kBoundsMs.size() + 1> buckets_{};
  std::uint64_t count_ = 0;
  TimeUs sum_us_ = 0;
};

}  // namespace runstone
