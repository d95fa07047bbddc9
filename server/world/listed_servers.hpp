// Listed servers: the list of the servers of the world, from which a client learns where else it
// may connect. The owner makes it: itself and the servers that follow. It sends the list to its
// players, and to those servers, which pass it on to their own players. A server that follows keeps
// the last list while there is no owner.
// Bounds: kServersMax servers. Thread: the world strand.
#pragma once
#include <cstdint>
#include <vector>

#include "protocol/codec/messages.hpp"
#include "server/world/clocks.hpp"

namespace runstone {

struct WorldState;

/// A change of the numbers of players alone is sent this often at most.
inline constexpr TimeUs kPlayerCountsUs = 10'000'000;
/// A new owner keeps the earlier list for so long, until the other servers have connected to it.
inline constexpr TimeUs kServersGatherUs = 3'000'000;

struct ListedServers {
  std::vector<ServerEntry> newest;  // as in Servers
  std::uint64_t number = 0;         // of the newest list, rising; 0: there was none yet
  TimeUs counts_due_us = 0;         // when a change of the numbers of players is sent next
  TimeUs held_until_us = 0;         // the list does not change before
};

/// Makes the list anew if it has changed and is due. Requires that this server owns the world. A
/// world with one server has no list, unless it had more of them before.
void update_listed_servers(WorldState& world, const Clocks& now);
/// Takes the list of the owner.
void take_listed_servers(WorldState& world, const Servers& list);
/// Keeps the list of the earlier owner for kServersGatherUs.
void hold_listed_servers(WorldState& world, const Clocks& now);
/// Sends the newest list to the players and servers that lack it. Those whose queue is full get it
/// on a later call.
void send_listed_servers(WorldState& world);

}  // namespace runstone
