// Presence: sends the list of players and their poses to every session. For n players this could
// cost n * n entries, so the list is sent as changes, and poses are sent less often and at most
// kPosesMax at a time. With 1,000 players each gets two messages of poses a second.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "server/world/order/order.hpp"
#include "server/world/rights/rights.hpp"
#include "server/world/sessions/sessions.hpp"

namespace runstone {

/// Poses in one message. The next message continues with the other players.
inline constexpr std::size_t kPosesMax = 64;
/// The interval between two messages is at least this times the number of sessions.
inline constexpr TimeUs kPoseIntervalUsPerSession = 500;

class Presence {
 public:
  Presence(const WorldConfig& config, Sessions& sessions, const Order& order, const Rights& rights)
      : config_(config), sessions_(sessions), order_(order), rights_(rights) {}

  /// Adds a session that has opened. `is_listed`: the list of players has changed.
  void enter(const Session& session, bool is_listed);
  void forget(const Session& session);
  /// Stores the player's pose.
  void on_move(Session& session, const Move& move, const Clocks& now);
  /// Sends the changes of the player list since the last call to every session, and the full list
  /// to sessions that have none. A session whose queue is full gets the full list on a later call.
  void broadcast_player_list();
  /// Sends changed poses to every session if the interval has passed, round robin over the players.
  void broadcast_poses(const Clocks& now);
  /// Sends the poses of all players to a new session.
  void send_all_poses_to(const Session& session);
  /// Sends every session the full list and all poses again, because another server did it before.
  void begin_anew();

 private:
  /// The facts in the player list about a player, besides the key.
  struct Entry {
    std::string name, role;
    friend bool operator==(const Entry&, const Entry&) = default;
  };
  using Entries = std::map<AuthorId, Entry>;
  Entries entries_now() const;
  PlayerName listed(AuthorId author, const Entry& entry) const;
  PlayerList full_list(const Entries& entries) const;
  PlayerList change_between(const Entries& before, const Entries& after) const;

  const WorldConfig& config_;
  Sessions& sessions_;
  const Order& order_;
  const Rights& rights_;
  bool has_list_changed_ = false;
  std::uint64_t rights_revision_ = 0;  // of the list that was sent, which has the roles
  Entries sent_;                       // the list that was sent last
  std::set<SessionId> have_list_;      // they got the full list and all changes since
  std::set<SessionId> moved_;          // their poses have changed since they were sent last
  TimeUs poses_us_ = 0;                // when poses were sent last
  SessionId pose_sent_last_ = 0;       // the session whose pose was sent last
};

}  // namespace runstone
