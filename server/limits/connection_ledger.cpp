#include "server/limits/connection_ledger.hpp"

#include <iterator>

namespace runstone {
namespace {

constexpr std::uint64_t kSecondsAtOnce = 10;
constexpr std::size_t kForgetSteps = 1'024;  // addresses more than were kept last time

}  // namespace

bool ConnectionLedger::take(AddressBlock from, TimeUs now_us) {
  if (per_second_ == 0) return true;
  if (size() > 2 * size_kept_ + kForgetSteps) forget_full(now_us);
  TokenBucket& bucket =
      buckets_.try_emplace(from, per_second_, kSecondsAtOnce * per_second_).first->second;
  return bucket.take(1, now_us);
}

void ConnectionLedger::forget_full(TimeUs now_us) {
  for (auto at = buckets_.begin(); at != buckets_.end();)
    at = at->second.is_full(now_us) ? buckets_.erase(at) : std::next(at);
  size_kept_ = size();
}

}  // namespace runstone
