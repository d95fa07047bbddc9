// Change rules: who may make which change of rights. The rules:
//   - A player gives and takes only what lies within the player's own rights, and acts only on
//     players who have fewer rights. Administrators act on everybody.
//   - The last administrator stays: a change after which no key would have the right `administer` is
//     refused, whoever makes it.
//   - A claim lies within the quota of its owner's role, has priority 0, and touches no ground that
//     its owner may not change.
#pragma once
#include <optional>
#include <string>

#include "common/rights/rights_state.hpp"

namespace runstone {

/// Who makes a change.
struct RightsActor {
  std::optional<PublicKey> key;  // nullopt: the console, which has every right
  // The server's settings name the key as an operator's: it has every right.
  bool is_operator = false;
};

/// Returns why the change may not be made, as a sentence for the one who makes it, or nullopt.
/// Requires a valid change. Names of roles and boxes are checked here: a grant of a role that does
/// not exist, for example, is refused. Cost: O(grants) for changes of roles; otherwise O(log n), and
/// that of decide_edit() for a box.
std::optional<std::string> why_refused(const RightsState& state, const RightsActor& actor,
                                       const RightsChange& change, TimeUs now_us);

/// Returns the change that takes the record's change back: it restores what the records before it
/// say, which are given in log order from the first. Returns nullopt if the record no longer decides
/// anything, because a later one has replaced it. Requires that records.back() is the newest.
struct RightsRecord {
  RightsChange change;
  ChangeOrigin origin;
};
std::optional<RightsChange> inverse_of(const std::vector<RightsRecord>& records, Sequence seq);

}  // namespace runstone
