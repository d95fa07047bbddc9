// Quotas: how much a player may use. The settings give each player the same; a role may give its
// players another amount.
#pragma once
#include <cstdint>
#include <optional>

#include "server/limits/budget_ledger.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Returns the edit budget of a player.
Budget edit_budget_of(const WorldState& world, const PublicKey& key);
/// Returns the largest radius of a player's view, in chunks.
std::uint8_t view_radius_max_of(const WorldState& world, const PublicKey& key);
/// Returns who pays for the edits of a player. `address`: see Payer.
Payer edit_payer(const WorldState& world, const PublicKey& key,
                 const std::optional<AddressBlock>& address);
/// Returns who pays for the chunk loads of a session.
Payer load_payer(const WorldState& world, const WorldSession& session);
/// Takes the price of a chunk that is generated or read from the budgets of the session's player and
/// address. Returns false, and takes nothing, if one of them is used up.
bool pay_load(WorldState& world, const WorldSession& session, const Clocks& now);

}  // namespace runstone
