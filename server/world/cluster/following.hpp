// Following: what this server does while another one owns the world. It gets every record of the
// log from the owner, applies it as the owner did, and sends it to its own players, who also get
// terrain, tiles and the past from here. What a player does goes to the owner (PlayersAtOwner). So
// no order is made here.
//   - The records that the owner had before the connection are read from the database.
//   - Records that are not durable are kept. If this server takes the world over, it writes those
//     that the owner has not written. So nothing is lost that has arrived here.
//   - What a client has sent is lost if the owner ends, or if the connection with it breaks, before
//     the owner has handled it. Clients are told so (Resumes), and send again the edits that have
//     no answer. The operation id keeps them from being applied twice.
//   - If the owner has ordered edits differently from what arrived here (it took the world over
//     from a server that had sent them), this server cannot go on (Ownership::find_fork()).
// Bounds: records that are not durable: those of the owner's log queue; messages of the owner that
// wait while records are read: kWaitingMax, then the connection is made anew.
//
// Thread: the world strand.
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/core/channel_binding.hpp"
#include "common/core/result.hpp"
#include "server/world/cluster/players_at_owner.hpp"
#include "server/world/cluster/resumes.hpp"
#include "server/world/cluster/server_list.hpp"
#include "server/world/commit/commits.hpp"

namespace runstone {

/// Records that a reader has found.
struct ReadLog {
  std::vector<PlayerRow> players;   // all of the store
  std::vector<NameClaim> names;     // all of the store
  std::vector<EditRecord> records;  // in order; may be the first ones of more
  Sequence last = 0;                // of the log
};

/// The facts with which a server becomes the owner of the world that it has followed.
struct Takeover {
  Epoch epoch = 1;  // raised
  ReadLog read;     // from the last record of this server on, to the end of the log
  Sequence checkpoint = 0;
  AuthorId author_max = 0;
  std::vector<LastPlace> places;
};

class Following {
 public:
  /// The parts of the world that following uses. All must outlive the object.
  struct World {
    const WorldConfig& config;
    WorldEnvironment& environment;
    Sessions& sessions;
    Order& order;
    Receipts& receipts;
    Commits& commits;
    Joining& joining;
    Followers& followers;
    ServerList& servers;
    OwnerLink& link;
    PlayersAtOwner& players;
    Resumes& resumes;
  };
  explicit Following(const World& world) : world_(world) {}

  /// Begins to follow. There is no connection with the owner yet.
  void begin();
  /// Ends the connection with the owner, and what it says. Returns the parts of the log that the
  /// owner may not have written, in order.
  std::vector<LogPart> stop();
  /// Takes what a reader has found, up to the end of the log. Returns false if the log has other
  /// edits than this server.
  bool catch_up(const ReadLog& read, const Clocks& now);

  // The connection with the owner.
  void connected(const std::optional<ChannelBinding>& binding, const Clocks& now);
  void received(Message&& message, const Clocks& now);
  void disconnected();
  void missed_log_read(const Result<ReadLog, std::string>& read, const Clocks& now);
  /// Pings the owner, and leaves it if it is silent.
  void tick(const Clocks& now);

  // Players of this server.
  /// Takes an authenticated player to the owner, now or when there is one.
  void join(Session& session, const ClientAuth& auth);
  /// Reports the end of a session of a player to the owner, if it knows of the session.
  void forget(const Session& session);
  /// Handles a message of a player that is for the owner. Returns false if it is for this server.
  bool on_message(Session& session, const Message& message, const Clocks& now);

 private:
  /// A part of the log that may not be durable.
  struct KeptPart {
    LogPart part;
    TimeUs received_us = 0;  // steady clock
  };
  void leave(const std::string& why);
  void leave_slow() { leave(kOwnerReadsTooSlowly); }
  Result<void, std::string> take(const ReadLog& read, const Clocks& now);
  void apply_ordered(std::span<const LogPartRecord> records, const Clocks& now);
  void go_live(const Clocks& now);
  void read_more();
  void on_follow_answer(const FollowAnswer& answer, const Clocks& now);
  void on_live_message(const Message& message, const Clocks& now);
  void on_log_part(LogPart part, const Clocks& now);
  void on_durable(const Durable& durable, const Clocks& now);
  void on_relay(const Relay& relay, const Clocks& now);
  void on_relayed_accept(Session& session, const SessionAccepted& accepted, const Clocks& now);
  void on_relayed_reject(Session& session, Reject reject);

  World world_;
  Sequence read_to_ = 0;         // records up to it are read from the database
  bool is_reading_ = false;      // a reader reads
  TimeUs read_again_us_ = 0;     // when it reads next, because the records are not durable yet
  std::deque<Message> waiting_;  // of the owner, while records are read
  std::deque<KeptPart> not_durable_;
};

}  // namespace runstone
