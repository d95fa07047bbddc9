// EditLedger: the edit budgets of players and addresses. Every edit that a player causes is paid by
// the player's key, however many sessions it has, and by the address of the session, however many
// keys come from there. So nobody gains by more sessions, keys or reconnections. A budget that has
// refilled is forgotten, which bounds the memory by those who edited lately.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/core/address_block.hpp"
#include "common/core/token_bucket.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Who pays for an edit.
struct EditPayer {
  PublicKey key{};
  std::optional<AddressBlock> address;  // nullopt: the player has no session, and no address pays
};

class EditLedger {
 public:
  /// An address has `budgets_per_address` times the budget of a key; 0: addresses have no limit.
  EditLedger(const EditBudget& of_key, std::uint64_t budgets_per_address);

  struct Refusal {
    const char* whose = "";  // "key" or "address"
    TimeUs wait_us = 0;      // then the budget suffices, if nothing else is paid from it
    /// Returns text such as "the edit budget of your key is used up: again in 2.3 s".
    std::string text() const;
  };
  /// Takes the price from both budgets. Returns nullopt, or the refusal, and takes nothing then.
  /// Requires a price that edit_price() returned for the budget of a key. Cost: O(log payers).
  std::optional<Refusal> charge(const EditPayer& payer, std::uint64_t price, TimeUs now_us);

  /// Returns the number of budgets that are kept: all that are not full, and some that are.
  std::size_t size() const { return keys_.size() + addresses_.size(); }
  /// Forgets the budgets that have refilled. Cost: O(size()).
  void forget_full(TimeUs now_us);

 private:
  EditBudget of_key_, of_address_;
  std::map<PublicKey, TokenBucket> keys_;
  std::map<AddressBlock, TokenBucket> addresses_;
  std::size_t size_kept_ = 0;  // after the last forget_full()
};

}  // namespace runstone
