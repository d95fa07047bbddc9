// ReceiveAckScheduler: decides when a client acknowledges the chunk bytes it has read. From the
// acknowledgements the server computes the rate and the round trip of the link. One is due every
// kReceiveAckEveryUs, or after kReceiveAckEveryBytes if that is earlier, but no sooner than
// kReceiveAckUsMin after the one before. The last bytes are acknowledged too. Pure: times are
// arguments. One thread.
#pragma once
#include <cstdint>
#include <optional>

#include "common/core/ids.hpp"
#include "protocol/limits.hpp"

namespace runstone {

class ReceiveAckScheduler {
 public:
  /// Returns true if an acknowledgement is due. Then call sent(). `total` is the number of bytes of
  /// chunk frames read on this connection.
  bool is_due(std::uint64_t total, TimeUs now_us) const {
    const auto due_us = due(total);
    return due_us && now_us >= *due_us;
  }
  /// Returns when `total` is to be acknowledged if no more bytes come, or nullopt if it was
  /// acknowledged.
  std::optional<TimeUs> due(std::uint64_t total) const {
    if (total == acknowledged_) return std::nullopt;
    if (!sent_us_) return 0;
    return *sent_us_ +
           (total - acknowledged_ >= kReceiveAckEveryBytes ? kReceiveAckUsMin : kReceiveAckEveryUs);
  }
  void sent(std::uint64_t total, TimeUs now_us) {
    acknowledged_ = total;
    sent_us_ = now_us;
  }

 private:
  std::uint64_t acknowledged_ = 0;
  std::optional<TimeUs> sent_us_;
};

}  // namespace runstone
