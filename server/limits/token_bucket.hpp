// TokenBucket: a rate with a burst. Each use takes tokens; they come back with time. Answers a flooding peer.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

class TokenBucket {
 public:
  /// `per_second` tokens come back, at most `burst` are kept; starts full. A rate of 0 means "no limit".
  TokenBucket(std::uint64_t per_second, std::uint64_t burst)
      : per_second_(per_second), full_(burst * kPart), parts_(full_) {}

  /// Takes `count` tokens if they are there. `now_us` is of one steady clock; going back counts as standing.
  bool take(std::uint64_t count, TimeUs now_us) {
    if (per_second_ == 0) return true;
    if (!started_) {
      last_us_ = now_us;
      started_ = true;
    }
    if (now_us > last_us_) {
      // A part is a millionth of a token, so a microsecond at one token a second is one part: no rounding.
      const auto idle_us =
          static_cast<std::uint64_t>(std::min<TimeUs>(now_us - last_us_, kIdleUsMax));
      parts_ = std::min(full_, parts_ + idle_us * per_second_);
      last_us_ = now_us;
    }
    if (parts_ / kPart < count) return false;
    parts_ -= count * kPart;
    return true;
  }

 private:
  static constexpr std::uint64_t kPart = 1'000'000;
  static constexpr TimeUs kIdleUsMax = 3'600'000'000;  // keeps the product far from 2^64
  std::uint64_t per_second_, full_, parts_;
  TimeUs last_us_ = 0;
  bool started_ = false;
};

}  // namespace runstone
