#include "server/limits/edit_ledger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace runstone {
namespace {

constexpr std::size_t kForgetStep = 1'024;  // budgets more than were kept last time

}  // namespace

EditLedger::EditLedger(const EditBudget& of_key, std::uint64_t budgets_per_address)
    : of_key_(of_key) {
  const std::uint64_t most = TokenBucket::kBurstMax / std::max<std::uint64_t>(1, of_key.burst);
  const std::uint64_t times = std::min(budgets_per_address, std::max<std::uint64_t>(1, most));
  of_address_ = {of_key.per_second * times, of_key.burst * times};
}

std::string EditLedger::Refusal::text() const {
  return fmt::format("the edit budget of your {} is used up: again in {:.1f} s", whose,
                     static_cast<double>(wait_us) / 1e6);
}

std::optional<EditLedger::Refusal> EditLedger::charge(const EditPayer& payer, std::uint64_t price,
                                                      TimeUs now_us) {
  if (!of_key_.is_limited()) return std::nullopt;
  if (size() > 2 * size_kept_ + kForgetStep) forget_full(now_us);
  TokenBucket& key = keys_.try_emplace(payer.key, of_key_.per_second, of_key_.burst).first->second;
  if (const TimeUs wait_us = key.wait_us(price, now_us); wait_us > 0)
    return Refusal{"key", wait_us};
  if (payer.address && of_address_.is_limited()) {
    TokenBucket& address =
        addresses_.try_emplace(*payer.address, of_address_.per_second, of_address_.burst)
            .first->second;
    if (const TimeUs wait_us = address.wait_us(price, now_us); wait_us > 0)
      return Refusal{"address", wait_us};
    address.take(price, now_us);
  }
  key.take(price, now_us);
  return std::nullopt;
}

void EditLedger::forget_full(TimeUs now_us) {
  const auto forget = [now_us](auto& buckets) {
    for (auto at = buckets.begin(); at != buckets.end();)
      at = at->second.is_full(now_us) ? buckets.erase(at) : std::next(at);
  };
  forget(keys_);
  forget(addresses_);
  size_kept_ = size();
}

}  // namespace runstone
