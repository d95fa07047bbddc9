// The answers of the commands `roles`, `grants`, `invites`, `bans`, `refusals` and `protected`.
// Each lists at most 500 entries; a last line counts the others. Players are named with the
// fingerprints of their keys.
#pragma once
#include <string>
#include <vector>

#include "common/rights/rights_state.hpp"
#include "server/admin/known_players.hpp"
#include "server/limits/recent_refusals.hpp"

namespace runstone {

/// Returns one line per role: name, rights, limits, number of grants, and record. The default role
/// is marked.
std::string role_list(const RightsState& state, const KnownPlayers& players);
/// Returns one line per grant: player, role, and record.
std::string grant_list(const RightsState& state, TimeUs now_us, const KnownPlayers& players);
/// Returns one line per invite that can be accepted: number, role, uses, end, and record.
std::string invite_list(const RightsState& state, TimeUs now_us, const KnownPlayers& players);
/// Returns one line: whether the world has a password, its role, and record.
std::string password_line(const RightsState& state, const KnownPlayers& players);
/// Returns one line per restriction in force: whom it is for, its end, reason, and record.
std::string restriction_list(const RightsState& state, TimeUs now_us, const KnownPlayers& players);
/// Returns one line per row: player, what was refused, how often and when last.
std::string refusal_list(const std::vector<RefusalRow>& rows, const KnownPlayers& players);
/// Returns one line per box: name, ground, priority, owner, who else may change it, and record.
std::string box_list(const std::vector<const Decided<ProtectedBox>*>& boxes,
                     const KnownPlayers& players);

}  // namespace runstone
