// ServerConnection: the client's end of a connection to a server, whatever the client keeps of the world.
//   offline -> connected() -> greeting (hello sent) -> proving (welcome checked, proof sent) -> open (ready came).
//   disconnected() leads back to offline from everywhere.
// It greets, proves, pings, sends view, pose and requests, and ends a silent connection; the session that owns it takes the
// rest of what a server says. The server proves its key with a signature; the key is pinned per world (first use trusts it, a
// change refuses). Pins, clock offset and the newest welcome outlive a connection. Pure: randomness and times are arguments
// (microseconds of the client's steady clock). One thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/replica/client_handshake.hpp"
#include "client/replica/clock_offset.hpp"
#include "client/replica/local_edits.hpp"
#include "client/replica/replica_changes.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr TimeUs kPingEveryUs = 1'000'000;
inline constexpr TimeUs kServerSilenceUsMax =
    15'000'000;                                 // with a ping a second, silence means a dead link
inline constexpr TimeUs kMoveEveryUs = 50'000;  // poses sent at most

enum class SessionState { offline, hello_sent, authenticating, open };

/// Why the last connection ended, as far as the protocol knows.
struct SessionEnd {
  GoodbyeReason reason = GoodbyeReason::closing;
  std::string text;
  bool by_server = false;  // it said goodbye; otherwise we did
  bool final = false;      // trying again with the same configuration is pointless
};

class ServerConnection {
 public:
  explicit ServerConnection(SessionConfig config) : config_(std::move(config)) {}

  // ---- from offline to open, and back

  /// A new byte stream is up. `nonce` must be fresh and random: it keeps old welcomes from being replayed.
  void connected(const Nonce& nonce, TimeUs now_us);
  void disconnected();

  /// What a message was.
  enum class Dispatch {
    handled,  // of the connection itself, which may have ended it; or nobody listens any more
    another_world,  // the welcome of another world than the last one: what is held of that means nothing here
    ready,        // the connection opened, and the message, a Ready, is whole
    for_session,  // none of these: whether it may come in this state is for the session to say
  };
  /// Takes hello's answers, pongs once open, and goodbyes; leaves other messages as they are.
  Dispatch receive(Message& message, const Arrival& arrival);
  /// The server said something sound that did not come by receive().
  void heard(TimeUs now_us) { heard_us_ = now_us; }

  /// Says goodbye, once; wants_close() is true afterwards.
  void close(GoodbyeReason reason, std::string text);
  /// Ends the connection by a fault of the server's, which another connection may be free of.
  void fail_with(GoodbyeReason reason, std::string text);

  // ---- what is sent

  /// Pings, the pose, silence. `ping_every_us`: kPingEveryUs at most. Returns whether the session may go on: it is open and
  /// not to be closed.
  bool tick(TimeUs now_us, TimeUs ping_every_us);
  /// When tick() has something to do next; never while offline.
  TimeUs tick_due_us(TimeUs ping_every_us) const;
  void send(Message message) { outgoing_.push_back(std::move(message)); }
  /// With the server's time of the click, if the offset of its clock is known.
  void send_edit(ClientSequence seq, const LocalEdit& own);
  /// In as many messages as their limit makes of them.
  void request_chunks(const std::vector<ChunkKey>& keys);
  /// The view to wish for from now on.
  void set_view(const View& view) { config_.view = view; }
  /// The view in force: the wished one within the server's limits.
  View view() const;
  /// Sends the view in force, unless it is what was sent last. Returns whether it was sent.
  bool send_view();
  bool view_was_sent() const { return view_sent_.has_value(); }
  /// Sent when it changes, every kMoveEveryUs at most.
  void set_pose(const Pose& pose) { pose_ = pose; }
  /// Messages to send, in order.
  std::vector<Message> take_outgoing();

  // ---- what is known

  SessionState state() const { return state_; }
  bool is_open() const { return state_ == SessionState::open; }
  /// The connection should be closed once what is queued is sent.
  bool wants_close() const { return wants_close_; }
  /// What the server says is heard: there is a connection, and it is not to be closed.
  bool accepts_input() const { return state_ != SessionState::offline && !wants_close_; }
  const std::optional<SessionEnd>& end() const { return end_; }
  /// Of the current or last connection; empty before the first.
  const std::optional<Welcome>& welcome() const { return welcome_; }
  AuthorId author() const { return author_; }
  std::uint64_t connect_count() const { return connect_count_; }
  std::uint64_t pongs() const { return pongs_; }
  const ClockOffset& clock() const { return clock_; }
  /// `view` is the wished one; `pinned` has the server keys given, and those of worlds seen for the first time.
  const SessionConfig& config() const { return config_; }

 private:
  /// Returns the stage of the handshake. Requires a connection.
  SessionStage stage() const;
  Dispatch on_welcome(Welcome welcome);
  void on_session_accepted(const SessionAccepted& ready, TimeUs now_us);

  SessionConfig config_;
  SessionState state_ = SessionState::offline;
  std::vector<Message> outgoing_;
  bool wants_close_ = false;
  std::optional<SessionEnd> end_;
  Hello hello_;
  std::optional<Welcome> welcome_;
  AuthorId author_ = 0;
  std::uint64_t connect_count_ = 0, pongs_ = 0;
  ClockOffset clock_;
  std::optional<View> view_sent_;
  Pose pose_;
  std::optional<Pose> pose_sent_;
  TimeUs ping_us_ = 0, heard_us_ = 0, move_us_ = 0;
};

}  // namespace runstone
