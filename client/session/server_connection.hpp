// ServerConnection: the client's end of a connection to a server. It is the same for clients with
// and without a replica. States:
//   offline --connected()--> hello_sent --Welcome--> authenticating --SessionAccepted--> open
// disconnected() leads back to offline from every state. The connection performs the handshake,
// sends pings, view, pose and requests, and ends a silent connection. The session that contains it
// handles all other messages. The server proves its key with a signature. The key is pinned per
// world: the first one is trusted, and another one is rejected. Pins, the newest welcome and the
// list of servers outlive a connection, and so does the clock offset unless there are several
// servers. Pure: randomness and times are arguments, in microseconds of the client's steady clock.
// One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/replica/local_edits.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/session/client_handshake.hpp"
#include "client/session/clock_offset.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr TimeUs kPingEveryUs = 1'000'000;
/// With a ping a second, a longer silence of the server means that the link is dead.
inline constexpr TimeUs kServerSilenceUsMax = 15'000'000;
/// Poses are sent at most this often.
inline constexpr TimeUs kMoveEveryUs = 50'000;

enum class SessionState { offline, hello_sent, authenticating, open };

/// Why the last connection ended, as far as the protocol knows.
struct SessionEnd {
  GoodbyeReason reason = GoodbyeReason::closing;
  std::string text;
  bool by_server = false;  // the server said goodbye; otherwise this client did
  bool final = false;      // another attempt with the same configuration is pointless
};

class ServerConnection {
 public:
  explicit ServerConnection(SessionConfig config) : config_(std::move(config)) {}

  /// Begins a connection on a new byte stream. `nonce` must be fresh and random, so that old
  /// welcomes cannot be replayed. `binding` identifies an encrypted stream; the signatures of both
  /// sides hold for it alone. `is_listed`: the address comes from servers(), and the user did not
  /// give it. Such a server must be one of the same world; if it is not, another attempt may
  /// succeed.
  void connected(const Nonce& nonce, const std::optional<ChannelBinding>& binding, TimeUs now_us,
                 bool is_listed = false);
  void disconnected();

  /// How the connection dispatched a message.
  enum class Dispatch {
    handled,           // by the connection, which may have ended; or it accepts no input any more
    another_world,     // the welcome of another world: what the session holds is of the last world
    session_accepted,  // the connection is open now; the message is SessionAccepted, unchanged
    materials_added,   // welcome() has more materials now, or materials with other shapes
    for_session,       // the session decides whether the message is allowed in this state
  };
  /// Handles the messages of the handshake, pongs, new materials, shapes and the time of the world
  /// once open, and goodbyes. Leaves other messages as they are.
  Dispatch receive(Message& message, const Arrival& arrival);
  /// Notes that a valid message arrived that did not pass through receive().
  void note_message(TimeUs now_us) { last_message_us_ = now_us; }

  /// Queues a goodbye, once. wants_close() returns true afterwards.
  void close(GoodbyeReason reason, std::string text);
  /// Ends the connection because of a fault of the server. Another connection may succeed.
  void fail_with(GoodbyeReason reason, std::string text);

  /// Sends pings and the pose, and ends a silent connection. Requires ping_every_us <=
  /// kPingEveryUs. Returns true if the connection is open and is not to be closed.
  bool tick(TimeUs now_us, TimeUs ping_every_us);
  /// Returns when tick() has something to do next; never while offline.
  TimeUs tick_due_us(TimeUs ping_every_us) const;
  void send(Message message) { outgoing_.push_back(std::move(message)); }
  /// Sends an edit, with the time of the click on the server's clock if the clock offset is known.
  void send_edit(ClientSequence seq, const LocalEdit& local);
  /// Sends chunk requests of at most kChunkRequestKeysMax keys each. Requires strictly ascending
  /// keys.
  void request_chunks(const std::vector<ChunkKey>& keys);
  /// Sets the password, which is sent from the next connection on.
  void set_password(std::shared_ptr<PasswordKeys> password);
  /// Sets the requested view; its number is ignored. send_view() sends it.
  void set_view(const View& view) { config_.view = view; }
  /// Returns the view in force: the requested one within the server's limits. Its number is that
  /// with which it was sent, or with which send_view() would send it. Views of a connection are
  /// counted from 1.
  View view() const;
  /// Sends the view in force, unless it was sent last. Returns true if it was sent.
  bool send_view();
  bool view_was_sent() const { return view_sent_.has_value(); }
  /// Sets the pose. tick() sends it when it changes, every kMoveEveryUs at most.
  void set_pose(const Pose& pose) { pose_ = pose; }
  /// Returns the messages to send, in order.
  std::vector<Message> take_outgoing();

  SessionState state() const { return state_; }
  bool is_open() const { return state_ == SessionState::open; }
  /// Returns true if the connection should be closed once what is queued has been sent.
  bool wants_close() const { return wants_close_; }
  /// Returns true if there is a connection and it is not to be closed.
  bool accepts_input() const { return state_ != SessionState::offline && !wants_close_; }
  const std::optional<SessionEnd>& end() const { return end_; }
  /// Returns true if the server ended the handshake with `not_admitted`, the world has a password,
  /// and none was sent.
  bool lacks_password() const { return lacks_password_; }
  /// Returns the welcome of the current or last connection, or nullopt before the first. Its
  /// material table has the rows that came later, too.
  const std::optional<Welcome>& welcome() const { return welcome_; }
  /// Returns the newest list of the world's servers. It is empty until one comes, and in another
  /// world.
  const Servers& servers() const { return servers_; }
  /// Returns a number that rises with each change of servers().
  std::uint64_t servers_number() const { return servers_number_; }
  /// Returns how often materials of welcome() were given shapes.
  std::uint64_t shapes_number() const { return shapes_number_; }
  AuthorId author() const { return author_; }
  /// Returns where the player was last in the world, as the server of this connection says, or
  /// nullopt if it does not know.
  const std::optional<Pose>& place() const { return place_; }
  /// Returns the time of the world, or nullopt if the world has no clock that this client knows.
  std::optional<WorldTime> world_time(TimeUs now_us) const {
    if (!time_) return std::nullopt;
    return later(*time_, now_us - time_us_);
  }
  std::uint64_t connect_count() const { return connect_count_; }
  std::uint64_t pongs() const { return pongs_; }
  const ClockOffset& clock() const { return clock_; }
  /// `view` is the requested one. `pinned` has the configured server keys, and those of worlds seen
  /// for the first time.
  const SessionConfig& config() const { return config_; }

 private:
  /// Returns the stage of the handshake. Requires a connection.
  SessionStage stage() const;
  Dispatch on_welcome(Welcome welcome);
  /// Returns why the welcome is rejected, or nullopt.
  std::optional<WelcomeFault> fault_of(const Welcome& welcome);
  /// Ends the connection for a reason for which another attempt is pointless.
  Dispatch give_up(GoodbyeReason reason, const std::string& text);
  void on_session_accepted(const SessionAccepted& accepted, TimeUs now_us);
  Dispatch on_materials(const MaterialsAdded& added);
  Dispatch on_shapes(const ShapesGiven& shapes);

  SessionConfig config_;
  SessionState state_ = SessionState::offline;
  std::vector<Message> outgoing_;
  bool wants_close_ = false;
  std::optional<SessionEnd> end_;
  bool lacks_password_ = false;
  Hello hello_;
  std::optional<ChannelBinding> binding_;  // of the current connection
  bool is_listed_ = false;                 // its address
  std::optional<Welcome> welcome_;
  Servers servers_;
  std::uint64_t servers_number_ = 0;
  std::uint64_t shapes_number_ = 0;
  AuthorId author_ = 0;
  std::optional<Pose> place_;
  std::optional<WorldTime> time_;  // of the world, at time_us_
  TimeUs time_us_ = 0;
  std::uint64_t connect_count_ = 0, pongs_ = 0;
  ClockOffset clock_;
  std::optional<View> view_sent_;
  Pose pose_;
  std::optional<Pose> pose_sent_;
  TimeUs ping_us_ = 0, last_message_us_ = 0, move_us_ = 0;
};

}  // namespace runstone
