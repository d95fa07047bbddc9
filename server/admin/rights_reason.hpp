// The answer of the command `why`: whether a player has a right, and which record decides it.
#pragma once
#include <optional>
#include <string>

#include "common/rights/rights_state.hpp"
#include "server/admin/known_players.hpp"

namespace runstone {

/// Returns the restriction behind a reason, or nullopt if the reason is another one.
std::optional<RestrictionKind> restriction_of(RightsDecision::Reason reason);
/// Returns "banned until 2026-11-21T23:57:42Z: griefing": what holds for the key at `now_us`.
std::string why_restricted(const RightsState& state, RestrictionKind kind, const PublicKey& key,
                           TimeUs now_us);
/// Returns "record 12, 2026-11-21T23:57:42Z, by ana #3 9M1Q-Z7CR-04KD", or "built in".
std::string origin_text(const ChangeOrigin& origin, const KnownPlayers& players);

struct RightsQuestion {
  PublicKey key{};
  Right right{};
  std::optional<VoxelPos> at;  // with Right::build: whether the player may change this voxel
};

/// Returns two lines: the answer, and the record that decides it.
std::string rights_reason(const RightsState& state, const RightsQuestion& question, TimeUs now_us,
                          const KnownPlayers& players);

}  // namespace runstone
