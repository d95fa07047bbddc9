// BudgetLedger: the budgets that players and addresses have of one kind of work, such as edits. The
// work that a player causes is paid by the player's key, however many sessions it has, and by the
// address of the session, however many keys come from there. So nobody gains by more sessions, keys
// or reconnections. A budget that has refilled is forgotten, which bounds the memory by those who
// paid lately.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstdint>
#include <map>
#include <optional>

#include "common/core/address_block.hpp"
#include "common/core/budget.hpp"
#include "common/core/public_key.hpp"
#include "common/core/token_bucket.hpp"

namespace runstone {

/// Who pays.
struct Payer {
  PublicKey key{};
  std::optional<AddressBlock> address;  // nullopt: the player has no session, and no address pays
  Budget budget;                        // of the key, as the player's role says
};

class BudgetLedger {
 public:
  /// `usual`: the budget of a key whose role says nothing else. An address has
  /// `budgets_per_address` times as much; 0: addresses have no limit.
  BudgetLedger(const Budget& usual, std::uint64_t budgets_per_address);

  struct Refusal {
    const char* whose = "";  // "key" or "address"
    TimeUs wait_us = 0;      // then the budget suffices, if nothing else is paid from it
  };
  /// Takes the price from both budgets. Returns nullopt, or the refusal, and takes nothing then. An
  /// address pays in shares of the key's budget: a key of a role with ten times the usual budget
  /// uses up a tenth as much of its address. A key whose budget differs from that of its last
  /// payment begins with a full one. Requires a price of at most payer.budget.burst if the budget
  /// is limited. Cost: O(log payers).
  std::optional<Refusal> charge(const Payer& payer, std::uint64_t price, TimeUs now_us);

  /// Takes the price of work that was done already from both budgets. What they lack is owed: later
  /// tokens pay for it first, up to a full budget.
  void owe(const Payer& payer, std::uint64_t price, TimeUs now_us);

  /// Returns the number of budgets that are kept: all that are not full, and some that are.
  std::size_t size() const { return keys_.size() + addresses_.size(); }
  /// Forgets the budgets that have refilled. Cost: O(size()).
  void forget_full(TimeUs now_us);

 private:
  struct Account {
    explicit Account(const Budget& full) : budget(full), left(full.per_second, full.burst) {}
    Budget budget;
    TokenBucket left;
  };
  /// Returns the account of the payer's key.
  Account& account_of(const Payer& payer, TimeUs now_us);
  /// Returns the price of the same work in the units of an address.
  std::uint64_t address_price(const Budget& key_budget, std::uint64_t price) const;

  Budget usual_, address_budget_;
  std::map<PublicKey, Account> keys_;
  std::map<AddressBlock, Account> addresses_;
  std::size_t size_kept_ = 0;  // after the last forget_full()
};

}  // namespace runstone
