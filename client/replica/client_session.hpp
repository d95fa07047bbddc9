// ClientSession: one client's side of the protocol, around a Replica: view, edits, travels, commands, the others, resumption,
// upon a ServerConnection. It consumes messages and produces messages; who carries them (a socket, a simulated link) is not
// its business. When the connection ends, the replica and own edits stay, and are resumed by the next one. Pure: randomness
// and times are arguments (microseconds of the client's steady clock). One thread.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client/replica/cache_question.hpp"
#include "client/replica/replica.hpp"
#include "client/replica/server_connection.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr TimeUs kPingEveryFirstUs =
    50'000;  // until kPingsFirst pongs are in: the clock offset is wanted soon
inline constexpr unsigned kPingsFirst = 4;
inline constexpr TimeUs kOffsetWaitUsMax =
    1'000'000;  // edits wait this long for the first pong, then go without
/// Ready travels with the edits; messages of the other classes may overtake it. So many are held back for it.
inline constexpr std::size_t kEarlyMessagesMax = 4096;
inline constexpr TimeUs kCacheWaitUsMax = 250'000;  // that a view waits for what a cache has of it
inline constexpr std::size_t kCommandLinesKept = 4096;  // of one command's output
inline constexpr TimeUs kAnswerUsMax = 10'000'000;  // an edit not answered by then is offered again

struct OtherPlayer {
  std::string name;
  std::optional<Pose> pose;
};

class ClientSession {
 public:
  explicit ClientSession(SessionConfig config);

  /// A new byte stream is up. `nonce` must be fresh and random: it keeps old welcomes from being replayed.
  void connected(const Nonce& nonce, TimeUs now_us);
  void disconnected();
  /// Takes one decoded message. After an error the session wants to close (wants_close()) and a goodbye is
  /// queued.
  void receive(Message message, const Arrival& arrival);
  /// Pings, repeated requests, silence. Call about every 10 ms.
  void tick(TimeUs now_us);
  /// Messages to send, in order. Edits may overtake the others (they travel in a class of their own).
  std::vector<Message> take_outgoing() { return connection_.take_outgoing(); }
  /// The connection should be closed once what is queued is sent.
  bool wants_close() const { return connection_.wants_close(); }
  /// Says goodbye; wants_close() is true afterwards.
  void close(GoodbyeReason reason, std::string text) { connection_.close(reason, std::move(text)); }

  /// Shows and sends an edit. `submitted_us`: the click or the scheduled time; latency counts from there.
  Result<ClientSequence> submit(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us);
  void set_view(const View& view);
  /// Asks to see the view as it was at a moment of the past, read-only, or as it is. `travel.request` is given here. The
  /// live world is not touched, nor what others see. Fails before ready.
  Result<void> travel(HistoryRequest travel);
  /// Gives the server a command, such as "undo". One at a time. bad_value, also if it is no text of 1 ..
  /// kCommandBytesMax bytes, and unknown_kind if the server takes no commands.
  Result<void> command(std::string text);
  /// A command was sent and its answer is not complete.
  bool commanding() const { return is_commanding_; }
  /// What came of the newest command: its lines so far, and, once it is complete, whether it did what it was asked. A
  /// connection that ends leaves it undone.
  const std::vector<std::string>& command_lines() const { return command_lines_; }
  bool command_ok() const { return is_command_ok_; }
  /// A wish to travel was sent, and not everything has come that it asked for.
  bool travelling() const { return travelled_ != travel_request_; }
  /// Why the newest wish was refused; empty if it was not.
  const std::string& travel_refusal() const { return travel_refusal_; }
  /// Chunks to look up before the next view is sent, if the session has a cache; nothing if there are none. The view waits
  /// for the answer, kCacheWaitUsMax at most.
  std::optional<CacheQuestion> take_question();
  /// What the cache has of the oldest question that was not answered; may come late, or after the connection ended.
  void answer(std::vector<KeptChunk> found, TimeUs now_us);
  /// The world as its server describes it now; nothing unless open.
  std::optional<CachedWorld> cached_world() const;
  void set_pose(const Pose& pose) { connection_.set_pose(pose); }

  SessionState state() const { return connection_.state(); }
  bool is_open() const { return connection_.is_open(); }
  const std::optional<SessionEnd>& end() const { return connection_.end(); }
  /// Of the current or last connection; empty before the first.
  const std::optional<Welcome>& welcome() const { return connection_.welcome(); }
  AuthorId author() const { return connection_.author(); }
  OperationId operation(ClientSequence seq) const {
    return {author(), connection_.config().instance, seq};
  }
  /// The view in force: the wished one within the server's limits.
  View view() const { return connection_.view(); }
  /// Number of chunks in view.
  std::size_t view_chunks() const;
  /// Of every chunk in view the snapshot came on this connection, or the word that it is unavailable; and
  /// none waits to be repaired.
  bool loaded() const;
  /// Counts pongs; a ping sent after a moment has come back once it rises by two from then.
  std::uint64_t pongs() const { return connection_.pongs(); }
  const ClockOffset& clock() const { return connection_.clock(); }
  const std::map<AuthorId, OtherPlayer>& others() const { return others_; }
  /// Server keys by world: those given, and those of worlds seen for the first time.
  const std::map<WorldId, PublicKey>& pinned() const { return connection_.config().pinned; }
  std::uint64_t connect_count() const { return connection_.connect_count(); }

  Replica& replica() { return replica_; }
  const Replica& replica() const { return replica_; }

 private:
  void on_session_accepted(const SessionAccepted& ready, TimeUs now_us);
  void on_command_output(CommandOutput output);
  void on_player_list(const PlayerList& roster);
  void on_poses(const PlayerPoses& poses);
  void on_history_state(const HistoryState& moment);
  /// Sends the view, and before it what of it is held; waits for the cache if there is something to ask it.
  void wish_view();
  void send_view();
  void send_waiting_edits(TimeUs now_us);

  ServerConnection connection_;
  Replica replica_;
  std::vector<std::pair<Message, Arrival>> early_;  // came before ready

  std::uint32_t travel_request_ = 0;  // of the newest wish on this connection; 0: none
  std::uint32_t travelled_ = 0;       // the newest one that was fulfilled or refused
  std::string travel_refusal_;
  std::uint32_t command_ = 0;  // id of the newest one
  bool is_commanding_ = false, is_command_ok_ = false;
  std::vector<std::string> command_lines_;  // kCommandLinesKept at most

  std::vector<ClientSequence> waiting_;  // own edits to send, ascending
  // Of this connection: what the cache was or will be asked for, and how many answers are to come.
  std::set<ChunkKey> asked_;
  std::vector<ChunkKey> questions_;
  std::size_t answers_due_ = 0, answers_stale_ = 0;
  std::optional<TimeUs> view_waits_since_us_;
  TimeUs now_us_ = 0, opened_us_ = 0;  // now: of the last call that told it
  std::map<AuthorId, OtherPlayer> others_;
};

}  // namespace runstone
