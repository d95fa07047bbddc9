// Cluster: this server among the servers of one world: those that follow it while it owns the
// world, the owner that it follows otherwise, and the change from one to the other.
//
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/world/cluster/handover.hpp"

namespace runstone {

class Cluster {
 public:
  /// The parts of the world that the cluster uses. All must outlive the object.
  struct World {
    const WorldConfig& config;
    WorldEnvironment& environment;
    WorldCounters& counters;
    Sessions& sessions;
    Order& order;
    Receipts& receipts;
    Commits& commits;
    Joining& joining;
    EditRequests& edits;
    Presence& presence;
    ChatRoom& chat;
    Visits& visits;
    PlayerPlaces& places;
  };
  Cluster(const World& world, const RandomBytes& random);

  // The part of this server in its world.
  bool is_following() const { return world_.order.is_following(); }
  /// Returns true if this server is the owner, and no other one can be it.
  bool owns_world() const { return world_.order.owns_world(); }
  /// Returns false if this server follows, and has not reached the owner.
  bool is_live() const { return !is_following() || link_.is_live(); }
  /// Returns true if this server has edits that the log does not have. It cannot go on then.
  bool has_forked() const { return world_.order.ownership().is(OwnershipState::forked); }
  /// Returns when this server last heard the owner that it follows, by the steady clock, or nullopt
  /// if it is not connected with one.
  std::optional<TimeUs> owner_heard_us() const { return link_.heard_us(); }
  /// Returns the number of servers that follow this one.
  std::size_t follower_count() const { return followers_.count(); }
  /// Returns why no CorrectTime may be ordered, as a sentence, or nullopt.
  std::optional<std::string> correction_refusal() const { return followers_.correction_refusal(); }
  /// Returns why no change of the library may be ordered, as a sentence without its period, or
  /// nullopt.
  std::optional<std::string> library_refusal() const { return followers_.library_refusal(); }
  /// Returns why no shapes may be ordered, as a sentence without its period, or nullopt.
  std::optional<std::string> shapes_refusal() const { return followers_.shapes_refusal(); }
  /// Returns why no textures may be ordered, as a sentence without its period, or nullopt.
  std::optional<std::string> textures_refusal() const { return followers_.textures_refusal(); }
  /// Returns why the clock of the world may not be set, as a sentence without its period, or
  /// nullopt.
  std::optional<std::string> clock_refusal() const { return followers_.clock_refusal(); }
  /// Returns the reason why no role may be given for some time, as a sentence without its period,
  /// or nullopt.
  std::optional<std::string> timed_grant_refusal() const {
    return followers_.timed_grant_refusal();
  }
  // These return what the functions of Handover with the same names return.
  std::vector<KnownServer> known_servers() const { return handover_.known_servers(); }
  std::optional<std::string> handover_refusal(std::optional<SessionId> successor) const {
    return handover_.refusal(successor);
  }
  std::optional<SessionId> take_better_owner() { return handover_.take_better_owner(); }
  /// Returns true if a stop is under way, and another server waits to take the world over.
  bool hands_over() const { return hands_over_; }

  // Following the owner.
  /// From now on another server owns the world, and this one follows it.
  void follow();
  /// The connection with the owner. Ignored unless is_following().
  void owner_connected(const std::optional<ChannelBinding>& binding, const Clocks& now);
  void owner_received(Message&& message, const Clocks& now);
  void owner_disconnected();
  /// Handles the answer to WorldEnvironment::read_missed_log().
  void missed_log_read(const Result<ReadLog, std::string>& read, const Clocks& now);
  /// Reports that the owner has moved the checkpoint: every edit up to it is contained in
  /// snapshots.
  void checkpoint_moved(Sequence checkpoint);
  /// Stops following, because the caller has the lease of the world. Players stay; what they do
  /// waits. Returns the parts of the log that the earlier owner may not have written, in order. The
  /// caller writes those whose records the log lacks, then calls take_over().
  std::vector<LogPart> stop_following();
  /// Makes this server the owner. Sessions go on, and edits that wait are ordered. Returns false if
  /// the log has other edits than this server: nothing may be written then.
  bool take_over(const Takeover& start, const Clocks& now);
  /// Reports that the database failed before take_over(). The server must be stopped.
  void takeover_failed() { world_.order.ownership().fail_takeover(); }

  // Handing over. The caller then writes the log, calls handover_written(), and gives the lease up.
  // Reports about the log may come until then.
  SessionId hand_over(std::optional<SessionId> successor, const Clocks& now) {
    return handover_.hand_over(successor, now);
  }
  void handover_written(const Clocks& now);

  // Sessions.
  bool is_follower(SessionId link) const { return followers_.contains(link); }
  void admit_follower(Session& session, const Clocks& now) { followers_.admit(session, now); }
  /// See Followers::received().
  std::optional<RelayedMessage> follower_received(SessionId link, const Message& message,
                                                  const Clocks& now) {
    return followers_.received(link, message, now);
  }
  void forget_follower(SessionId link) { followers_.forget(link); }
  /// Takes an authenticated player to the owner. Requires is_following().
  void join_at_owner(Session& session, const ClientAuth& auth) { following_.join(session, auth); }
  /// Handles a message of a player that is for the owner. Returns false if it is for this server.
  bool on_message_for_owner(Session& session, const Message& message, const Clocks& now) {
    return is_following() && following_.on_message(session, message, now);
  }
  void on_resumed(Session& session) { resumes_.on_resumed(session); }
  /// Returns true if edits of the session were sent before its client knew that another server
  /// orders now. They will be offered again.
  bool ignores_edits(const Session& session) const { return resumes_.ignores_edits(session); }
  void count_edit(const Session& session) { handover_.count_edit(session); }
  void forget(const Session& session);

  // The log, a tick, and the end.
  void send_durable_to_followers() { followers_.send_durable(); }
  /// Closes followers that are lost, and the owner if it is silent. Call it first on every tick.
  void check_connections(const Clocks& now);
  /// Makes the list of servers and looks for a better owner. For the owner.
  void tick_owner(const Clocks& now);
  void send_servers() { servers_.send(); }
  /// Closes all followers, because the server stops.
  void begin_stop();

 private:
  World world_;
  Followers followers_;
  ServerList servers_;
  OwnerLink link_;
  PlayersAtOwner players_;
  Resumes resumes_;
  Following following_;
  Handover handover_;
  bool hands_over_ = false;
};

}  // namespace runstone
