// TokenBucket: limits a rate, with a burst. Each use takes tokens, and tokens are added with time.
// It protects a server from clients that cost too much. A client keeps one too, so that it knows
// beforehand what the server will refuse.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include "common/core/ids.hpp"

namespace runstone {

class TokenBucket {
 public:
  /// Adds `per_second` tokens a second and keeps at most `burst`. The bucket starts full. A rate of
  /// 0 means no limit. A burst of more than kBurstMax is kBurstMax.
  TokenBucket(std::uint64_t per_second, std::uint64_t burst)
      : per_second_(std::min(per_second, kPerSecondMax)),
        full_(std::min(burst, kBurstMax) * kPart),
        parts_(full_) {}

  /// Takes `count` tokens. Returns false, and takes none, if there are fewer. `now_us` is of one
  /// steady clock. A time before the last one adds no tokens.
  bool take(std::uint64_t count, TimeUs now_us) {
    if (wait_us(count, now_us) != 0) return false;
    if (per_second_ != 0) parts_ -= count * kPart;
    return true;
  }
  /// Returns how long it takes until there are `count` tokens if none are taken: 0 if they are
  /// there, kNever if the bucket cannot hold them.
  TimeUs wait_us(std::uint64_t count, TimeUs now_us) {
    if (per_second_ == 0) return 0;
    add_tokens(now_us);
    if (count > full_ / kPart) return kNever;
    const std::uint64_t needed = count * kPart + owed_;
    if (needed <= parts_) return 0;
    return static_cast<TimeUs>((needed - parts_ + per_second_ - 1) / per_second_);
  }
  bool is_full(TimeUs now_us) {
    add_tokens(now_us);
    return parts_ == full_;
  }
  /// Takes `count` tokens for something that was already done. Missing tokens are owed, at most as
  /// many as the bucket holds: the next tokens pay for them.
  void charge(std::uint64_t count, TimeUs now_us) {
    add_tokens(now_us);
    const std::uint64_t price = std::min(count, kBurstMax) * kPart;
    const std::uint64_t paid = std::min(price, parts_);
    parts_ -= paid;
    owed_ = std::min(full_, owed_ + (price - paid));
  }
  /// Takes all tokens.
  void drain(TimeUs now_us) {
    add_tokens(now_us);
    parts_ = 0;
  }

  static constexpr TimeUs kNever = std::numeric_limits<TimeUs>::max();
  static constexpr std::uint64_t kPerSecondMax = 1'000'000'000, kBurstMax = 1'000'000'000'000;

 private:
  void add_tokens(TimeUs now_us) {
    if (!started_) {
      last_us_ = now_us;
      started_ = true;
    }
    if (now_us <= last_us_) return;
    // A part is a millionth of a token. One token a second is one part a microsecond, so nothing is
    // rounded.
    const auto idle_us = static_cast<std::uint64_t>(now_us - last_us_);
    last_us_ = now_us;
    const std::uint64_t missing = full_ - parts_ + owed_;
    // The product cannot overflow: it is below `missing`.
    const bool is_filled = idle_us > missing / std::max<std::uint64_t>(1, per_second_);
    const std::uint64_t added = is_filled ? missing : idle_us * per_second_;
    const std::uint64_t paid = std::min(owed_, added);
    owed_ -= paid;
    parts_ += added - paid;
  }

  static constexpr std::uint64_t kPart = 1'000'000;
  std::uint64_t per_second_, full_, parts_;
  std::uint64_t owed_ = 0;  // not 0 only if parts_ is 0
  TimeUs last_us_ = 0;
  bool started_ = false;
};

}  // namespace runstone
