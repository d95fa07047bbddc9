// Followers: the other servers of the world that follow this one, which owns it. Each is connected
// like a player, but has proved that it holds the world's own key. It gets every record of the log
// (LogFeed), and passes on what its players do: their sessions are handled here like those of
// players who are connected here, except that the follower sends them terrain and commits. Bounds:
// a follower whose send queue is full is closed. It connects again and reads what it has missed
// from the database. Its players pay for their messages like all others.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "server/world/order/receipts.hpp"
#include "server/world/people/joining.hpp"

namespace runstone {

/// A server that follows.
struct Follower {
  ClientInstance instance = 0;              // of the server's process
  TimeUs last_message_us = 0;               // steady clock
  std::map<SessionId, SessionId> sessions;  // its players: by its number, the number here
  std::uint64_t edits = 0;                  // of its players, accepted since it connected
  // The list of servers (server_list.hpp).
  std::string player_address, page_address;  // as in FollowRequest
  bool takes_servers = false;                // it knows the message
  bool takes_corrections = false;            // it knows a CorrectTime
  bool takes_library = false;                // it knows a LibraryChange
  bool takes_shapes = false;                 // it knows GivenShapes
  bool takes_textures = false;               // it knows a GivenTexture
  bool takes_clock = false;                  // it knows a ClockEdit
  bool takes_timed_grants = false;           // it knows a GrantRole with an end
  std::uint64_t servers_sent = 0;            // number of the last list
};

/// A follower that has sent nothing for so long is closed. It sends a ping each second.
inline constexpr TimeUs kFollowerSilentUsMax = 5'000'000;
/// After a handover, other followers stay connected for so long without an owner, from the moment
/// when the log is written.
inline constexpr TimeUs kFollowersKeptUs = 1'000'000;

/// A message of a player at another server.
struct RelayedMessage {
  Session& session;
  Message message;
};

class Followers {
 public:
  /// The arguments must outlive the object.
  Followers(const WorldConfig& config, WorldEnvironment& environment, WorldCounters& counters,
            Sessions& sessions, Order& order, const Receipts& receipts, Joining& joining)
      : config_(config),
        environment_(environment),
        counters_(counters),
        sessions_(sessions),
        order_(order),
        receipts_(receipts),
        joining_(joining) {}

  bool contains(SessionId link) const { return all_.contains(link); }
  const std::map<SessionId, Follower>& all() const { return all_; }
  std::map<SessionId, Follower>& all() { return all_; }
  std::size_t count() const { return all_.size(); }
  /// Returns why no CorrectTime may be ordered, as a sentence, or nullopt.
  std::optional<std::string> correction_refusal() const;
  /// Returns why no change of the library may be ordered, as a sentence without its period, or
  /// nullopt.
  std::optional<std::string> library_refusal() const;
  /// Returns why no shapes may be ordered, as a sentence without its period, or nullopt.
  std::optional<std::string> shapes_refusal() const;
  /// Returns why no textures may be ordered, as a sentence without its period, or nullopt.
  std::optional<std::string> textures_refusal() const;
  /// Returns why the clock of the world may not be set, as a sentence without its period, or
  /// nullopt.
  std::optional<std::string> clock_refusal() const;
  /// Returns the reason why no role may be given for some time, as a sentence without its period,
  /// or nullopt.
  std::optional<std::string> timed_grant_refusal() const;
  /// Returns the server through which a session is connected, or null if it is connected here.
  Follower* of_session(SessionId session);
  const Follower* of_session(SessionId session) const;

  /// Makes a follower of a session that has proved the world's own key.
  void admit(Session& session, const Clocks& now);
  /// Handles a message of a follower. Returns the message of a player that it has passed on, for
  /// the caller to handle. Requires that the link is a follower's.
  std::optional<RelayedMessage> received(SessionId link, const Message& message, const Clocks& now);
  /// Forgets a follower, and the sessions of its players.
  void forget(SessionId link);
  /// Reports that a session is removed. Its follower forgets it, too.
  void forget_session(const Session& session);
  /// Closes the followers that are silent, or whose queue was full, and those that have waited for
  /// long enough since this server handed the world over.
  void close_lost(const Clocks& now);
  /// Closes all followers, with this text, and forgets the sessions of their players, who stay
  /// connected to the followers.
  void close_all(const std::string& text);
  /// Hands the followers' sessions back, since this server owns the world no more: closes
  /// `successor`, and those that have not asked for the log yet. The others stay connected and get
  /// no records, so that messages of this server still arrive there, and they leave the free lease
  /// to the successor (TakeoverWatch).
  void keep_without_log(SessionId successor);
  /// Ends the wait of the followers that were kept.
  void close_kept_at(TimeUs steady_us) { kept_until_us_ = steady_us; }
  /// Sends the durable watermark to the followers, also to those that a former owner still has. So
  /// they need not read from the database what they know already.
  void send_durable();

 private:
  void close(SessionId link, GoodbyeReason reason, const std::string& text);
  void on_relay_open(SessionId link, const RelayOpen& open, const Clocks& now);
  std::optional<RelayedMessage> on_relay(SessionId link, const Relay& relay, const Clocks& now);
  void on_relay_close(SessionId link, const RelayClose& close);
  void on_follow_request(SessionId link, const FollowRequest& request, const Clocks& now);

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  WorldCounters& counters_;
  Sessions& sessions_;
  Order& order_;
  const Receipts& receipts_;
  Joining& joining_;
  std::map<SessionId, Follower> all_;  // by their session
  TimeUs kept_until_us_ = std::numeric_limits<TimeUs>::max();
};

}  // namespace runstone
