#include "server/world/rights/quotas.hpp"

#include <algorithm>

namespace runstone {

Quotas::Quotas(const WorldConfig& config, const Rights& rights)
    : config_(config),
      rights_(rights),
      edits_(config.edit_budget, config.budgets_per_address),
      loads_(config.chunk_loads, config.budgets_per_address) {}

/// Returns the role whose quotas count, or null if the settings alone do: those whom the settings
/// name as operators need no role.
const Role* Quotas::role_with_quotas(const PublicKey& key) const {
  if (rights_.is_operator(key)) return nullptr;
  const Role& role = rights_.state().role_of(key);
  return role.has_quotas() ? &role : nullptr;
}

Budget Quotas::edit_budget_of(const PublicKey& key) const {
  const Role* role = role_with_quotas(key);
  const bool has_own = role != nullptr && role->edit_budget.is_limited();
  return has_own ? role->edit_budget : config_.edit_budget;
}

std::uint8_t Quotas::view_radius_max_of(const PublicKey& key) const {
  const Role* role = role_with_quotas(key);
  const bool has_own = role != nullptr && role->view_radius_max != 0;
  return has_own ? std::min(role->view_radius_max, config_.view_radius_max)
                 : config_.view_radius_max;
}

Payer Quotas::edit_payer(const PublicKey& key, const std::optional<AddressBlock>& address) const {
  return {key, address, edit_budget_of(key)};
}

Payer Quotas::load_payer(const Session& session) const {
  const Role* role = role_with_quotas(session.key);
  const bool has_own = role != nullptr && role->chunk_loads_per_second != 0;
  return {session.key, session.address,
          has_own ? chunk_load_budget(role->chunk_loads_per_second) : config_.chunk_loads};
}

bool Quotas::pay_load(const Session& session, const Clocks& now) {
  return !loads_.charge(load_payer(session), 1, now.steady_us);
}

}  // namespace runstone
