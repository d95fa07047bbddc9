#include "tests/support/net/link_model.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone::test {

std::uint64_t LinkModel::queued_bytes(TimeNs now_ns) const {
  if (free_ns_ <= now_ns) return 0;
  constexpr double kBitNsPerByteSecond = 8e9;
  return static_cast<std::uint64_t>(static_cast<double>(free_ns_ - now_ns) *
                                    static_cast<double>(profile_.bits_per_second) /
                                    kBitNsPerByteSecond);
}

LinkPassage LinkModel::push(std::uint64_t bytes, TimeNs now_ns) {
  if (queued_bytes(now_ns) + bytes > profile_.queue_bytes() && free_ns_ > now_ns) {
    ++counts_.no_room;
    return {LinkFate::no_room, 0};
  }
  free_ns_ = std::max(free_ns_, now_ns) + profile_.transmit_ns(bytes);
  constexpr std::uint32_t kScale = 1U << 31;
  const bool lost = random_.below(kScale) < profile_.loss * kScale;
  // The number is drawn even if there is no jitter, so that one seed gives the same losses with any
  // jitter.
  const double swing = static_cast<double>(random_.below(kScale)) / kScale * 2 - 1;
  const TimeNs jitter = static_cast<TimeNs>(swing * static_cast<double>(profile_.jitter_ns));
  const TimeNs due_ns = std::max(last_due_ns_, free_ns_ + profile_.round_trip_ns / 2 + jitter);
  RUNSTONE_ASSERT(due_ns >= now_ns);
  if (lost) {
    ++counts_.lost;
    return {LinkFate::lost, due_ns};
  }
  last_due_ns_ = due_ns;
  ++counts_.packets;
  counts_.bytes += bytes;
  return {LinkFate::arrives, due_ns};
}

}  // namespace runstone::test
