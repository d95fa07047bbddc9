// ServerList: the list of the servers of the world, from which a client learns where else it
// may connect. The owner makes it: itself and the servers that follow. It sends the list to its
// players, and to those servers, which pass it on to their own players. A server that follows keeps
// the last list while there is no owner.
// Bounds: kServersMax servers.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "server/world/cluster/followers.hpp"

namespace runstone {

/// A change of the numbers of players alone is sent this often at most.
inline constexpr TimeUs kPlayerCountsUs = 10'000'000;
/// A new owner keeps the earlier list for so long, until the other servers have connected to it.
inline constexpr TimeUs kServersGatherUs = 3'000'000;

class ServerList {
 public:
  ServerList(const WorldConfig& config, WorldEnvironment& environment, Sessions& sessions,
             Order& order, Followers& followers)
      : config_(config),
        environment_(environment),
        sessions_(sessions),
        order_(order),
        followers_(followers) {}

  /// Makes the list anew if it has changed and is due. Requires that this server owns the world. A
  /// world with one server has no list, unless it had more of them before.
  void update(const Clocks& now);
  /// Takes the list of the owner.
  void take(const Servers& list);
  /// Keeps the list of the earlier owner for kServersGatherUs.
  void hold(const Clocks& now) { held_until_us_ = now.steady_us + kServersGatherUs; }
  /// Sends the newest list to the players and servers that lack it. Those whose queue is full get
  /// it on a later call.
  void send();
  void forget(SessionId session) { sent_.erase(session); }

 private:
  std::vector<ServerEntry> servers_now() const;
  void count_players(std::vector<ServerEntry>& servers) const;

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  Sessions& sessions_;
  Order& order_;
  Followers& followers_;
  std::vector<ServerEntry> newest_;          // as in Servers
  std::uint64_t number_ = 0;                 // of the newest list, rising; 0: there was none yet
  TimeUs counts_due_us_ = 0;                 // when a change of the numbers of players is sent next
  TimeUs held_until_us_ = 0;                 // the list does not change before
  std::map<SessionId, std::uint64_t> sent_;  // by session, the number of the last list
};

}  // namespace runstone
