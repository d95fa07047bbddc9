// Budget: how much of something a peer may use, with a burst. A TokenBucket holds what is left of
// it.
#pragma once
#include <cstdint>

namespace runstone {

/// Limits of a budget that somebody sets.
inline constexpr std::uint64_t kBudgetPerSecondMax = 1'000'000, kBudgetBurstMax = 100'000'000;

struct Budget {
  std::uint64_t per_second = 0;  // units that come back; 0: no limit
  std::uint64_t burst = 0;       // units at most, at least 1 if there is a limit
  bool is_limited() const { return per_second != 0; }
  friend bool operator==(const Budget&, const Budget&) = default;
};

}  // namespace runstone
