// Hazards of changes of rights: changes that are allowed, and that hit many players or open the
// world to everybody, so that a slip of the hand would cost much.
#pragma once
#include <optional>
#include <string>

#include "common/rights/rights_state.hpp"

namespace runstone {

/// Returns what the change would do, as a sentence without a period, or nullopt if nobody need be
/// warned. Warned of are
///   - rights over others (kRightsOverOthers) for players whom nobody has chosen: of the default
///     role, of the role of the password, and of an invite for several players;
///   - a ban of more addresses than an IPv4 /16 or an IPv6 /32;
///   - a protected box over more columns of ground than 16,384 x 16,384, if it is new, gets other
///     ground or a higher priority.
/// Requires a valid change. Cost: O(log n).
std::optional<std::string> hazard_of(const RightsState& state, const RightsChange& change);

/// Returns which rights a role would lose if it were defined like this, with the line that keeps
/// them, or nullopt if it loses none or does not exist. Whoever wants to add a right easily forgets
/// that the others must be named again.
std::optional<std::string> hazard_of_lost_rights(const RightsState& state, const Role& role);

}  // namespace runstone
