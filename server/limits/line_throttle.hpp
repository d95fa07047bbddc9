// LineThrottle: limits log lines that peers can cause to ten a second, so that no peer fills the
// disk. The next line that is written says how many were left out.
// Threads: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstdint>
#include <optional>
#include <utility>

#include "common/core/token_bucket.hpp"

namespace runstone {

class LineThrottle {
 public:
  /// Counts one line. Returns how many lines were left out before it, or nullopt if this line is
  /// left out too.
  std::optional<std::uint64_t> take(TimeUs now_us) {
    if (bucket_.take(1, now_us)) return std::exchange(left_out_, 0);
    ++left_out_;
    return std::nullopt;
  }

 private:
  static constexpr std::uint64_t kLinesPerSecond = 10;

  TokenBucket bucket_{kLinesPerSecond, kLinesPerSecond};
  std::uint64_t left_out_ = 0;
};

}  // namespace runstone
