#include "server/limits/budget_ledger.hpp"

#include <algorithm>
#include <iterator>

namespace runstone {
namespace {

constexpr std::size_t kForgetStep = 1'024;  // budgets more than were kept last time

}  // namespace

BudgetLedger::BudgetLedger(const Budget& usual, std::uint64_t budgets_per_address) : usual_(usual) {
  const std::uint64_t most = TokenBucket::kBurstMax / std::max<std::uint64_t>(1, usual.burst);
  const std::uint64_t times = std::min(budgets_per_address, std::max<std::uint64_t>(1, most));
  address_budget_ = {usual.per_second * times, usual.burst * times};
}

std::uint64_t BudgetLedger::address_price(const Budget& key_budget, std::uint64_t price) const {
  if (key_budget == usual_ || !key_budget.is_limited()) return price;
  // Rates and prices of this size cannot overflow the product.
  constexpr std::uint64_t kFactorMax = 1'000'000'000;
  const std::uint64_t scaled =
      std::min(price, kFactorMax) * std::min(usual_.per_second, kFactorMax) / key_budget.per_second;
  return std::clamp<std::uint64_t>(scaled, 1, address_budget_.burst);
}

BudgetLedger::Account& BudgetLedger::account_of(const Payer& payer, TimeUs now_us) {
  if (size() > 2 * size_kept_ + kForgetStep) forget_full(now_us);
  Account& key = keys_.try_emplace(payer.key, payer.budget).first->second;
  if (key.budget != payer.budget) key = Account(payer.budget);
  return key;
}

std::optional<BudgetLedger::Refusal> BudgetLedger::charge(const Payer& payer, std::uint64_t price,
                                                          TimeUs now_us) {
  if (!payer.budget.is_limited()) return std::nullopt;
  Account& key = account_of(payer, now_us);
  if (const TimeUs wait_us = key.left.wait_us(price, now_us); wait_us > 0)
    return Refusal{"key", wait_us};
  if (payer.address && address_budget_.is_limited()) {
    const std::uint64_t share = address_price(payer.budget, price);
    Account& address = addresses_.try_emplace(*payer.address, address_budget_).first->second;
    if (const TimeUs wait_us = address.left.wait_us(share, now_us); wait_us > 0)
      return Refusal{"address", wait_us};
    address.left.take(share, now_us);
  }
  key.left.take(price, now_us);
  return std::nullopt;
}

void BudgetLedger::owe(const Payer& payer, std::uint64_t price, TimeUs now_us) {
  if (!payer.budget.is_limited() || price == 0) return;
  account_of(payer, now_us).left.charge(price, now_us);
  if (!payer.address || !address_budget_.is_limited()) return;
  Account& address = addresses_.try_emplace(*payer.address, address_budget_).first->second;
  address.left.charge(address_price(payer.budget, price), now_us);
}

void BudgetLedger::forget_full(TimeUs now_us) {
  const auto forget = [now_us](auto& accounts) {
    for (auto at = accounts.begin(); at != accounts.end();)
      at = at->second.left.is_full(now_us) ? accounts.erase(at) : std::next(at);
  };
  forget(keys_);
  forget(addresses_);
  size_kept_ = size();
}

}  // namespace runstone
