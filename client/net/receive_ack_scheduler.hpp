// ReceiveAckScheduler: when a client tells the server how much terrain it has read, so that the server can tell how fast the link
// is and how long its round trip. At most every kReceiveAckEveryUs, or each kReceiveAckEveryBytes where that comes first, but
// never more often than every kReceiveAckUsMin; the last bytes are told too. Pure: times are arguments. One thread.
#pragma once
#include <cstdint>
#include <optional>

#include "common/core/ids.hpp"
#include "protocol/limits.hpp"

namespace runstone {

class ReceiveAckScheduler {
 public:
  /// `total`: bytes of chunk frames read on this connection. Whether to tell it now; then told() follows.
  bool is_due(std::uint64_t total, TimeUs now_us) const {
    const auto due_us = due(total);
    return due_us && now_us >= *due_us;
  }
  /// When `total` is to be told if nothing more comes; nothing if it was.
  std::optional<TimeUs> due(std::uint64_t total) const {
    if (total == told_) return std::nullopt;
    if (!told_us_) return 0;
    return *told_us_ +
           (total - told_ >= kReceiveAckEveryBytes ? kReceiveAckUsMin : kReceiveAckEveryUs);
  }
  void told(std::uint64_t total, TimeUs now_us) {
    told_ = total;
    told_us_ = now_us;
  }

 private:
  std::uint64_t told_ = 0;
  std::optional<TimeUs> told_us_;
};

}  // namespace runstone
