// Following: what this server does while another one owns the world. It gets every record of the log
// from the owner, applies it as the owner did, and sends it to its own players, who also get terrain,
// tiles and the past from here. What a player does goes to the owner: to join, to edit, to move, to
// write a line, to give a command. So no order is made here.
//   - The records that the owner had before the connection are read from the database.
//   - Records that are not durable are kept. If this server takes the world over, it writes those that
//     the owner has not written. So nothing is lost that has arrived here.
//   - What a client has sent is lost if the owner ends, or if the connection with it breaks, before the
//     owner has handled it. Clients are told so (Resume), and send again the edits that have no answer.
//     The operation id keeps them from being applied twice.
//   - If the owner has ordered edits differently from what arrived here (it took the world over from a
//     server that had sent them), this server cannot go on: WorldServer::has_forked().
// Bounds: records that are not durable: those of the owner's log queue; messages of the owner that wait
// while records are read: kWaitingMax, then the connection is made anew; edits whose wait is measured:
// kForwardedMax.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/channel_binding.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/clocks.hpp"
#include "server/world/player_rows.hpp"
#include "server/world/world_environment.hpp"

namespace runstone {

struct WorldState;
struct WorldSession;

/// Why a session ends if its client cannot resume.
inline constexpr const char* kConnectAgain =
    "another server has taken the world over: connect again";
/// The parts of the protocol that a server does not offer while it follows: they need what only the
/// owner has in memory.
inline constexpr std::uint64_t kFeaturesOfOwner =
    kFeatureKeyTransfer | kFeatureRestorePreview | kFeaturePreviews;

/// Records that a reader has found.
struct ReadLog {
  std::vector<PlayerRow> players;   // all of the store
  std::vector<NameClaim> names;     // likewise
  std::vector<EditRecord> records;  // in order; may be the first ones of more
  Sequence last = 0;                // of the log
};

/// What a server needs to become the owner of the world that it has followed.
struct Takeover {
  Epoch epoch = 1;  // raised
  ReadLog read;     // from the last record of this server on, to the end of the log
  Sequence checkpoint = 0;
  AuthorId author_max = 0;
};

/// A part of the log that may not be durable.
struct KeptPart {
  LogPart part;
  TimeUs received_us = 0;  // steady clock
};

struct Following {
  // The features of kFeaturesOfOwner that this server offers while it owns the world.
  std::uint64_t owner_features = 0;
  enum class Link {
    none,            // not connected
    greeting,        // Hello was sent
    authenticating,  // ClientAuth was sent
    asking,          // FollowRequest was sent
    reading,         // records up to `read_to` are read from the database
    live             // every message is applied as it arrives
  };
  Link link = Link::none;
  Hello hello;
  std::optional<ChannelBinding> binding;
  Epoch owner_epoch = 0;  // of the owner's start
  Sequence read_to = 0;
  bool is_reading = false;      // a reader reads
  TimeUs read_again_us = 0;     // when it reads next, because the records are not durable yet
  std::deque<Message> waiting;  // of the owner, while records are read
  TimeUs heard_us = 0, pinged_us = 0;  // steady clock: the last message, the last ping
  std::deque<KeptPart> not_durable;
  // Edits of players here that the owner got, until it answers: when they came (steady clock).
  std::map<OperationId, TimeUs> forwarded;
  bool has_forked = false;
  bool is_taking_over = false;  // messages of an owner are ignored
  // After a handover some followers are still connected with this server. They are closed at this time
  // at the latest (handover.hpp).
  TimeUs followers_end_us = std::numeric_limits<TimeUs>::max();
};

/// Makes this server one that follows and has no connection with the owner yet.
void begin_following(WorldState& world);

// The connection with the owner.
void owner_connected(WorldState& world, const std::optional<ChannelBinding>& binding,
                     const Clocks& now);
void on_owner_message(WorldState& world, Message&& message, const Clocks& now);
void owner_disconnected(WorldState& world);
void on_log_read(WorldState& world, const Result<ReadLog, std::string>& read, const Clocks& now);
/// Takes what a reader has found. Returns why the log is not the one that this server has followed, or
/// nullopt. Records that are known already must be the same.
std::optional<std::string> take_read(WorldState& world, const ReadLog& read, const Clocks& now);
/// Pings the owner, and leaves it if it is silent.
void tick_following(WorldState& world, const Clocks& now);

// Sessions of players.
/// Takes an authenticated player to the owner, now or when there is one.
void join_at_owner(WorldState& world, SessionId session, const ClientAuth& auth);
/// Handles a message of a player that is for the owner. Returns false if it is for this server.
bool on_message_for_owner(WorldState& world, SessionId session, const Message& message,
                          const Clocks& now);
/// Tells the owner that a session has ended.
void session_left(WorldState& world, SessionId session, const WorldSession& mine);

/// Applies records that another server has ordered, and sends them to the sessions.
void apply_log_part(WorldState& world, const LogPart& part, const Clocks& now);
/// Lets the client of an open session offer its edits again: `resolved` is the highest client sequence
/// that the server has resolved which orders now. Closes the session if the client cannot.
void send_resume(WorldState& world, SessionId session, ClientSequence resolved);
/// Begins an epoch of the log, in which all that came before stays.
void begin_epoch(WorldState& world, Epoch epoch);
/// Tells an open session of the epoch, unless it knows it. Closes the session if its client cannot go on
/// in another epoch.
void send_epoch(WorldState& world, SessionId session);

}  // namespace runstone
