// ClaimLedger: how many names the players of one address may claim within an hour. A claim is a row
// that stays in the store and in memory, so keys, which cost nothing, must not make them without
// end. An address that has its whole hour left is forgotten.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstdint>
#include <map>

#include "common/core/address_block.hpp"
#include "common/core/token_bucket.hpp"

namespace runstone {

class ClaimLedger {
 public:
  /// 0: no limit.
  explicit ClaimLedger(std::uint64_t claims_per_hour) : per_hour_(claims_per_hour) {}

  /// Counts a claim. Returns false, and counts nothing, if the address has used up its hour. Cost:
  /// O(log addresses), amortised.
  bool take(AddressBlock address, TimeUs now_us) {
    if (per_hour_ == 0) return true;
    if (addresses_.size() > 2 * size_kept_ + kSizeFree) {
      std::erase_if(addresses_, [&](auto entry) { return entry.second.is_full(now_us); });
      size_kept_ = addresses_.size();
    }
    const auto bucket =
        addresses_.try_emplace(address, TokenBucket(per_hour_, per_hour_ * kSecondsPerHour)).first;
    return bucket->second.take(kSecondsPerHour, now_us);
  }

 private:
  static constexpr std::uint64_t kSecondsPerHour = 3'600;  // a claim costs as many tokens
  static constexpr std::size_t kSizeFree = 1'024;

  std::uint64_t per_hour_;
  std::map<AddressBlock, TokenBucket> addresses_;
  std::size_t size_kept_ = 0;
};

}  // namespace runstone
