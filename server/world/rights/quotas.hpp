// Quotas: how much a player may use, and who pays for it. The settings give each player the same; a
// role may give its players another amount.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <optional>

#include "server/limits/budget_ledger.hpp"
#include "server/world/rights/rights.hpp"

namespace runstone {

class Quotas {
 public:
  Quotas(const WorldConfig& config, const Rights& rights);

  /// Returns the edit budget of a player.
  Budget edit_budget_of(const PublicKey& key) const;
  /// Returns the largest radius of a player's view, in chunks.
  std::uint8_t view_radius_max_of(const PublicKey& key) const;
  /// Returns who pays for the edits of a player. `address`: see Payer.
  Payer edit_payer(const PublicKey& key, const std::optional<AddressBlock>& address) const;
  /// Takes the price of an edit. Returns nullopt, or the refusal, and takes nothing then.
  std::optional<BudgetLedger::Refusal> charge_edit(const Payer& payer, std::uint64_t price,
                                                   TimeUs now_us) {
    return edits_.charge(payer, price, now_us);
  }

  /// Returns who pays for the chunks that are loaded for a session.
  Payer load_payer(const Session& session) const;
  /// Takes the price of a chunk that is generated or read from the budgets of the session's player
  /// and address. Returns false, and takes nothing, if one of them is used up.
  bool pay_load(const Session& session, const Clocks& now);
  /// Takes the price of chunks that were generated or read already (BudgetLedger::owe()).
  void owe_loads(const Payer& payer, std::uint64_t chunks, TimeUs now_us) {
    loads_.owe(payer, chunks, now_us);
  }

 private:
  const Role* role_with_quotas(const PublicKey& key) const;

  const WorldConfig& config_;
  const Rights& rights_;
  BudgetLedger edits_;
  BudgetLedger loads_;  // a unit is a chunk that is generated or read for a view
};

}  // namespace runstone
