// TokenBucket: limits a rate, with a burst. Each use takes tokens, and tokens are added with time.
// It protects the server from clients that send too much.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

class TokenBucket {
 public:
  /// Adds `per_second` tokens a second and keeps at most `burst`. The bucket starts full. A rate of
  /// 0 means no limit.
  TokenBucket(std::uint64_t per_second, std::uint64_t burst)
      : per_second_(per_second), full_(burst * kPart), parts_(full_) {}

  /// Takes `count` tokens. Returns false, and takes none, if there are fewer. `now_us` is of one
  /// steady clock. A time before the last one adds no tokens.
  bool take(std::uint64_t count, TimeUs now_us) {
    if (per_second_ == 0) return true;
    if (!started_) {
      last_us_ = now_us;
      started_ = true;
    }
    if (now_us > last_us_) {
      // A part is a millionth of a token. One token a second is one part a microsecond, so nothing
      // is rounded.
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
