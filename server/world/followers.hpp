// Followers: the other servers of the world that follow this one, which owns it. Each is connected like
// a player, but has proved that it holds the world's own key. It gets every record of the log, and
// passes on what its players do: their sessions are handled here like those of players who are
// connected here, except that the follower sends them terrain and commits.
// Bounds: a follower whose send queue is full is closed. It connects again and reads what it has missed
// from the database. Its players pay for their messages like all others.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "protocol/codec/messages.hpp"
#include "server/world/clocks.hpp"
#include "server/world/player_rows.hpp"
#include "server/world/world_environment.hpp"

namespace runstone {

struct WorldState;
struct OrderedBatch;

/// A server that follows.
struct Follower {
  bool gets_log = false;        // it has asked for it
  ClientInstance instance = 0;  // of the server's process
  bool is_full = false;         // its queue was full: it has missed records, and is closed soon
  TimeUs last_message_us = 0;   // steady clock
  std::map<SessionId, SessionId> sessions;  // its players: by its number, the number here
  std::uint64_t edits = 0;                  // of its players, accepted since it connected
  // The list of servers (listed_servers.hpp).
  std::string player_address, page_address;  // as in FollowRequest
  bool takes_servers = false;                // it knows the message
  std::uint64_t servers_sent = 0;            // number of the last list
};

/// Returns true if the server gets the log.
inline bool is_served(const Follower& follower) { return follower.gets_log && !follower.is_full; }

/// A follower that has sent nothing for so long is closed. It sends a ping each second.
inline constexpr TimeUs kFollowerSilentUsMax = 5'000'000;

/// Makes a follower of a session that has proved the world's own key.
void admit_follower(WorldState& world, SessionId link, const Clocks& now);
/// Handles a message of a follower. Requires that the link is one.
void on_follower_message(WorldState& world, SessionId link, const Message& message,
                         const Clocks& now);
/// Forgets a follower, and the sessions of its players.
void forget_follower(WorldState& world, SessionId link);
/// Closes the followers that are silent, or whose queue was full.
void close_lost_followers(WorldState& world, const Clocks& now);
/// Returns true if another server gets the log.
bool has_live_followers(const WorldState& world);
/// Closes all followers, with this text, and forgets the sessions of their players, who stay connected
/// to the followers.
void close_followers(WorldState& world, const std::string& text);

/// Queues rows of players and the records of a commit for the log, and sends them to the followers.
void append_to_log(WorldState& world, std::vector<PlayerRow> players, OrderedBatch& batch);
/// The same for rows of players without records.
void append_players(WorldState& world, std::vector<PlayerRow> players);
void append_names(WorldState& world, std::vector<NameChange> changes);
/// Sends the durable watermark to the followers, also to those that a former owner still has
/// (handover.hpp). So they need not read from the database what they know already.
void send_durable_to_followers(WorldState& world);

}  // namespace runstone
