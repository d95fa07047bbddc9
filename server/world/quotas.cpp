#include "server/world/quotas.hpp"

#include <algorithm>

namespace runstone {
namespace {

/// Returns the role whose quotas count, or null if the settings alone do: those whom the settings
/// name as operators need no role.
const Role* role_with_quotas(const WorldState& world, const PublicKey& key) {
  if (world.config.operators.contains(key)) return nullptr;
  const Role& role = world.rights.role_of(key);
  return role.has_quotas() ? &role : nullptr;
}

}  // namespace

Budget edit_budget_of(const WorldState& world, const PublicKey& key) {
  const Role* role = role_with_quotas(world, key);
  const bool has_own = role != nullptr && role->edit_budget.is_limited();
  return has_own ? role->edit_budget : world.config.edit_budget;
}

std::uint8_t view_radius_max_of(const WorldState& world, const PublicKey& key) {
  const Role* role = role_with_quotas(world, key);
  const std::uint8_t of_server = world.config.view_radius_max;
  const bool has_own = role != nullptr && role->view_radius_max != 0;
  return has_own ? std::min(role->view_radius_max, of_server) : of_server;
}

Payer edit_payer(const WorldState& world, const PublicKey& key,
                 const std::optional<AddressBlock>& address) {
  return {key, address, edit_budget_of(world, key)};
}

Payer load_payer(const WorldState& world, const WorldSession& session) {
  const Role* role = role_with_quotas(world, session.key);
  const bool has_own = role != nullptr && role->chunk_loads_per_second != 0;
  return {session.key, session.address,
          has_own ? chunk_load_budget(role->chunk_loads_per_second) : world.config.chunk_loads};
}

bool pay_load(WorldState& world, const WorldSession& session, const Clocks& now) {
  return !world.load_ledger.charge(load_payer(world, session), 1, now.steady_us);
}

}  // namespace runstone
