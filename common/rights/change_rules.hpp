// Change rules: who may make which change of rights. The rules:
//   - Grants need the right `grant` or `administer`; restrictions need `moderate`; roles, the
//     default role, the password, bans of more addresses than an IPv4 /24 or an IPv6 /48, and a
//     correction of the time need `administer`.
//   - A player gives only what lies within the player's own rights, and gives roles and
//     restrictions to, and takes them from, only players who have fewer rights. Administrators act
//     on everybody. No player acts on itself, and a banned player makes no change.
//   - The last administrator stays: a change after which no key that is not banned would have the
//     right `administer` is refused, whoever makes it. If the default role has this right, every
//     key has it.
//   - The right `protect` allows every box. The owner of a box may remove it, and may change its
//     place, members and roles, but not its owner and priority.
//   - A claim is a box that a player with the right `claim` makes or moves. It belongs to the
//     player, lies within the quota of the player's role and has priority 0 if it is new. It
//     touches no ground that its owner may not change, and no box of another owner: among boxes of
//     equal priority the newer one decides, so a claim could take ground from somebody who shares
//     it.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/rights/rights_state.hpp"

namespace runstone {

/// Who makes a change.
struct RightsActor {
  std::optional<PublicKey> key;  // nullopt: the console, which has every right
  // The server's settings name the key as an operator's: it has every right.
  bool is_operator = false;
};

inline constexpr std::size_t kRolesMax = 256;
inline constexpr std::size_t kGrantsMax = 100'000;
inline constexpr std::size_t kTimedGrantsMax = 1'000;     // in force
inline constexpr std::size_t kRestrictionsMax = 100'000;  // also those that have ended
inline constexpr std::size_t kBoxesMax = 100'000;
inline constexpr std::size_t kClaimedBoxesMax = 90'000;  // the rest is for the right `protect`
inline constexpr std::size_t kInvitesMax = 1'000;

/// Returns why the change may not be made, as a sentence for the one who makes it, or nullopt.
/// Requires a valid change. Names of roles and boxes are checked here: a grant of a role that does
/// not exist, for example, is refused. Cost: O(grants log n) for changes of roles and for grants to
/// and bans of administrators; otherwise O(log n), and that of decide_edit() for a box.
std::optional<std::string> why_refused(const RightsState& state, const RightsActor& actor,
                                       const RightsChange& change, TimeUs now_us);

/// A change as the log holds it.
struct RightsRecord {
  RightsChange change;
  ChangeOrigin origin;
};
/// Returns the change that takes the record's change back: it restores what the records before it
/// say of the same role, grant, default role, password, restriction or box. `records` are given in
/// log order from the first to the newest. Returns nullopt if there is no record `seq`, if it
/// corrects the time, or if it no longer decides anything, because a later one has replaced it.
/// Ends are those that corrections of the time have moved. A grant is restored only if it has no
/// end. Cost: O(records log n).
std::optional<RightsChange> inverse_of(const std::vector<RightsRecord>& records, Sequence seq);

}  // namespace runstone
