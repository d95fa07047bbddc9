// Name rules: who may join under which name, and when a name becomes the property of a key.
#pragma once
#include <optional>
#include <string>

#include "server/world/world_state.hpp"

namespace runstone {

/// Returns why the session may not have its name, for goodbye name_refused, or nullopt. The name
/// breaks a rule of name_fault(), is reserved, belongs to another key, or the key owns
/// names_per_key others already. Changes nothing. Cost: O(log claims).
std::optional<std::string> name_refusal(const WorldState& world, const WorldSession& mine);

/// Makes the session's key own its name, if the client keeps its key (kFeatureNames) and nobody
/// owns the name. Nothing is claimed while the log has no room, once the address has claimed
/// names_per_address in an hour, and beyond kNameClaimsMax: the player then joins as one whose
/// client does not keep its key, and the next join tries again. Requires !name_refusal().
void claim_name(WorldState& world, SessionId session, TimeUs now_us);

/// Returns true if the session's key owns its name and the claim is not on disk yet. Nobody waits
/// for a full disk.
bool waits_for_claim(const WorldState& world, const WorldSession& mine);

/// Frees a name. Returns the claim that it had, or the reason why nothing changed.
Result<NameClaim, std::string> release_name(WorldState& world, const std::string& name);

}  // namespace runstone
