// Handover: the owner of the world lets a server that follows it take the world over, and goes on as a
// server that follows. Its players stay connected, like the players at the other servers.
//   1. Everything that is queued is ordered and sent to the followers.
//   2. The server follows from now on. Edits that arrive are ignored. Their clients get a Resume from
//      the next owner, and offer the edits again that have no answer.
//   3. The connection with the successor is closed, behind all records. It takes the world over when
//      the caller has written the log and gives the lease up.
//   4. The other followers stay connected, and get no records. Messages of this server still arrive
//      there, so they leave the free lease to the successor (TakeoverWatch). They are closed when this
//      server follows the next owner, or kFollowersKeptUs after the log was written.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/world/clocks.hpp"

namespace runstone {

struct WorldState;

/// Other followers stay connected for so long without an owner, from the moment when the log is written.
inline constexpr TimeUs kFollowersKeptUs = 1'000'000;

/// A server of the world, as the owner knows it.
struct KnownServer {
  std::optional<SessionId> link;  // its session; nullopt: this server
  std::string player_address;     // may be empty
  std::size_t players = 0;        // open sessions
  std::uint64_t edits = 0;        // of its players, accepted since it connected, or owns the world
};

/// Returns the servers of the world: this one first, then those that follow, ascending. Requires that
/// this server owns the world.
std::vector<KnownServer> known_servers(const WorldState& world);
/// Counts an edit that was accepted from a session.
void count_edit(WorldState& world, SessionId session);

/// Returns why the world cannot be handed over to this server (nullopt: to any), as a sentence, or
/// nullopt.
std::optional<std::string> handover_refusal(const WorldState& world,
                                            std::optional<SessionId> successor);
/// Makes this server one that follows. `successor` is the server that is to take the world over;
/// nullopt: the one with the most players, the lowest number of several. Returns its number.
/// Requires that handover_refusal() returns nullopt.
SessionId hand_over(WorldState& world, std::optional<SessionId> successor, const Clocks& now);
/// Closes the followers that a former owner still has when they have waited for long enough.
void close_kept_followers(WorldState& world, const Clocks& now);

/// Looks for a server to which the world should move (OwnerChoice), if the setting says so. Requires
/// that this server owns the world.
void choose_owner(WorldState& world, const Clocks& now);

}  // namespace runstone
