#include "server/limits/address_ledger.hpp"

#include <map>

namespace runstone {
namespace {

constexpr std::size_t kForgetSteps = 1'024;  // budgets more than were kept last time

}  // namespace

bool AddressLedger::take(AddressBlock from, std::uint64_t price, TimeUs now_us) {
  if (!address_budget_.is_limited()) return true;
  const Budgets budgets = budgets_of(from, now_us);
  if (budgets.address.wait_us(price, now_us) > 0) return false;
  return budgets.range.take(price, now_us) && budgets.address.take(price, now_us);
}

void AddressLedger::charge(AddressBlock from, std::uint64_t price, TimeUs now_us) {
  if (!address_budget_.is_limited()) return;
  budgets_of(from, now_us).address.charge(price, now_us);
}

void AddressLedger::charge_range(AddressBlock from, std::uint64_t price, TimeUs now_us) {
  if (!address_budget_.is_limited()) return;
  const Budgets budgets = budgets_of(from, now_us);
  budgets.address.charge(price, now_us);
  budgets.range.charge(price, now_us);
}

AddressLedger::Budgets AddressLedger::budgets_of(AddressBlock from, TimeUs now_us) {
  if (size() > 2 * size_kept_ + kForgetSteps) forget_full(now_us);
  TokenBucket& address =
      addresses_.try_emplace(from, address_budget_.per_second, address_budget_.burst).first->second;
  TokenBucket& range =
      ranges_
          .try_emplace(address_range_of(from), address_budget_.per_second * kBudgetsPerRange,
                       address_budget_.burst * kBudgetsPerRange)
          .first->second;
  return {address, range};
}

bool AddressLedger::has(AddressBlock from, std::uint64_t price, TimeUs now_us) const {
  const auto has = [&](const std::map<AddressBlock, TokenBucket>& budgets, AddressBlock of) {
    const auto found = budgets.find(of);
    if (found == budgets.end()) return price <= address_budget_.burst;
    return TokenBucket(found->second).wait_us(price, now_us) == 0;
  };
  if (!address_budget_.is_limited()) return true;
  return has(addresses_, from) && has(ranges_, address_range_of(from));
}

void AddressLedger::forget_full(TimeUs now_us) {
  const auto is_full = [now_us](const auto& entry) {
    return TokenBucket(entry.second).is_full(now_us);
  };
  std::erase_if(addresses_, is_full);
  std::erase_if(ranges_, is_full);
  size_kept_ = size();
}

}  // namespace runstone
