// The text of a change of rights, for the command `log` and for answers.
#pragma once
#include <string>

#include "common/rights/rights_change.hpp"

namespace runstone {

/// Returns "see,build,undo" in the order of Right, or "none".
std::string rights_text(RightSet rights);
/// Returns the rights and the limits that are set: "see,build volume 1000 claims 3 claim-volume
/// 4096", as `role set` reads them.
std::string role_text(const Role& role);
/// Returns "1 2 3 to 4 5 6", both corners inside, or "columns 1 3 to 4 6" for a box from the bottom
/// to the top of the world.
std::string ground_text(const VoxelBox& box);
/// Returns "banned", "muted" or "frozen".
const char* restricted_text(RestrictionKind kind);
/// Returns the fingerprint of the key, or the range.
std::string subject_text(const RestrictionSubject& subject);
/// Returns what follows the name of a box: ground, priority, owner, members and roles, with the
/// fingerprints of keys.
std::string box_text(const ProtectedBox& box);

/// Returns the number of an invite as commands take it: 16 hexadecimal digits.
std::string invite_id_text(InviteId invite);
/// Returns text such as "9f86d081884c7d65: role builder, 5 uses, until 2026-12-01T00:00:00Z".
std::string invite_text(const Invite& invite);

/// Returns a length of time in its two greatest units, such as "730d2h", as commands take it.
std::string apart_text(TimeUs us);

/// Returns one line such as "banned 9M1Q-Z7CR-04KD until 2026-11-21T23:57:42Z: griefing". Players
/// are named by the fingerprints of their keys.
std::string rights_change_text(const RightsChange& change);

}  // namespace runstone
