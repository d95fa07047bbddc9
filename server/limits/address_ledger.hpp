// AddressLedger: how often the peers of each network address may do what costs the server something
// before they are known, such as connecting. An address pays from a budget of its own, and from a
// larger one that its range shares, the /24 of IPv4 or the /48 of IPv6: somebody who has a whole
// range gains little by it. A budget that has refilled is forgotten, which bounds the memory by the
// addresses that paid lately.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>

#include "common/core/address_block.hpp"
#include "common/core/budget.hpp"
#include "common/core/token_bucket.hpp"

namespace runstone {

class AddressLedger {
 public:
  /// A range has so many times the budget of an address.
  static constexpr std::uint64_t kBudgetsPerRange = 16;

  explicit AddressLedger(const Budget& address_budget) : address_budget_(address_budget) {}

  /// Takes the price from both budgets. Returns false, and takes nothing, if one of them has less.
  /// Cost: O(log addresses), amortised.
  bool take(AddressBlock from, std::uint64_t price, TimeUs now_us);

  /// Takes the price of something that was already done from the budget of the address. The missing
  /// part is owed, at most as much as the budget holds. The range does not pay: one address must
  /// not keep its neighbours out. Cost: O(log addresses), amortised.
  void charge(AddressBlock from, std::uint64_t price, TimeUs now_us);

  /// Takes the price of something that was already done from the budgets of the address and of its
  /// range. It is for work that is so costly that the addresses of one range must not each have a
  /// full budget of it.
  void charge_range(AddressBlock from, std::uint64_t price, TimeUs now_us);

  /// Returns true if take() would take the price. Cost: O(log addresses).
  bool has(AddressBlock from, std::uint64_t price, TimeUs now_us) const;

  /// Returns the number of budgets that are kept.
  std::size_t size() const { return addresses_.size() + ranges_.size(); }

 private:
  struct Budgets {
    TokenBucket &address, &range;
  };
  /// Returns the budgets of the address, which are full ones if none are kept.
  Budgets budgets_of(AddressBlock from, TimeUs now_us);
  void forget_full(TimeUs now_us);

  const Budget address_budget_;
  std::map<AddressBlock, TokenBucket> addresses_, ranges_;
  std::size_t size_kept_ = 0;  // after the last forget_full()
};

}  // namespace runstone
