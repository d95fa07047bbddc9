// Handover: the owner of the world lets a server that follows it take the world over, and goes on
// as a server that follows. Its players stay connected, like the players at the other servers.
//   1. Everything that is queued is ordered and sent to the followers.
//   2. The server follows from now on. Edits that arrive are ignored. Their clients get a Resume
//      from the next owner, and offer the edits again that have no answer.
//   3. The connection with the successor is closed, behind all records. It takes the world over
//      when the caller has written the log and gives the lease up.
//   4. The other followers stay connected, and get no records (Followers::keep_without_log()). They
//      are closed when this server follows the next owner, or kFollowersKeptUs after the log was
//      written.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/world/cluster/following.hpp"
#include "server/world/cluster/owner_choice.hpp"

namespace runstone {

/// A server of the world, as the owner knows it.
struct KnownServer {
  std::optional<SessionId> link;  // its session; nullopt: this server
  std::string player_address;     // may be empty
  std::size_t players = 0;        // open sessions
  std::uint64_t edits = 0;        // of its players, accepted since it connected, or owns the world
};

class Handover {
 public:
  Handover(const WorldConfig& config, WorldEnvironment& environment, Sessions& sessions,
           Order& order, Commits& commits, ChatRoom& chat, Followers& followers,
           Following& following)
      : config_(config),
        environment_(environment),
        sessions_(sessions),
        order_(order),
        commits_(commits),
        chat_(chat),
        followers_(followers),
        following_(following) {}

  /// Returns the servers of the world: this one first, then those that follow, ascending. Requires
  /// that this server owns the world.
  std::vector<KnownServer> known_servers() const;
  /// Counts an edit that was accepted from a session.
  void count_edit(const Session& session);
  /// This server owns the world from now on.
  void begin_owning(const Clocks& now);

  /// Returns why the world cannot be handed over to this server (nullopt: to any), as a sentence,
  /// or nullopt.
  std::optional<std::string> refusal(std::optional<SessionId> successor) const;
  /// Makes this server one that follows. `successor` is the server that is to take the world over;
  /// nullopt: the one with the most players, the lowest number of several. Returns its number.
  /// Requires that refusal() returns nullopt.
  SessionId hand_over(std::optional<SessionId> successor, const Clocks& now);

  /// Looks for a server to which the world should move (OwnerChoice), if the setting says so.
  /// Requires that this server owns the world.
  void choose_owner(const Clocks& now);
  /// Returns the server to which the owner should hand the world over now, or nullopt. Returns each
  /// answer once. Players may make their edits elsewhere then.
  std::optional<SessionId> take_better_owner();

 private:
  SessionId follower_with_most_players() const;
  void close_joining_sessions();

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  Sessions& sessions_;
  Order& order_;
  Commits& commits_;
  ChatRoom& chat_;
  Followers& followers_;
  Following& following_;
  std::uint64_t edits_here_ = 0;  // of players here, accepted since this server owns the world
  OwnerChoice choice_;
  std::optional<SessionId> better_owner_;
};

}  // namespace runstone
