// ClientSession: a client's side of the protocol, around a Replica and on top of a
// ServerConnection. It handles the view, edits, history, commands, other players and reconnection.
// It consumes messages and produces messages; a socket or a simulated link carries them. When the
// connection ends, the replica and the local edits stay, and the next connection resumes them.
// Pure: randomness and times are arguments, in microseconds of the client's steady clock. One
// thread.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/replica/cache_lookup.hpp"
#include "client/replica/replica.hpp"
#include "client/session/chat_inbox.hpp"
#include "client/session/edit_allowance.hpp"
#include "client/session/history_requests.hpp"
#include "client/session/library_exchange.hpp"
#include "client/session/log_timeline.hpp"
#include "client/session/lost_edits.hpp"
#include "client/session/server_connection.hpp"
#include "client/session/shared_previews.hpp"
#include "client/session/texture_exchange.hpp"
#include "client/session/voxel_author.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Pings are this frequent until kPingsFirst pongs arrived, because the clock offset is needed
/// soon.
inline constexpr TimeUs kPingEveryFirstUs = 50'000;
inline constexpr unsigned kPingsFirst = 4;
/// Edits wait this long for the first pong. Then they are sent without a time.
inline constexpr TimeUs kOffsetWaitUsMax = 1'000'000;
/// The number of messages that are held back until SessionAccepted arrives. It has the class of the
/// edits, so messages of other classes may overtake it. Chunks are not among them, because they
/// answer a view, which is sent later.
inline constexpr std::size_t kEarlyMessagesMax = 64;
/// Lines kept of the output of one command.
inline constexpr std::size_t kCommandLinesKept = 4096;
/// An edit without an answer is sent again after this.
inline constexpr TimeUs kAnswerUsMax = 10'000'000;

struct OtherPlayer {
  std::string name;
  PublicKey key{};
  std::optional<Pose> pose;
  std::string role = {};  // empty: the server did not name it
};

class ClientSession {
 public:
  explicit ClientSession(SessionConfig config);

  /// Begins a connection on a new byte stream. `nonce` must be fresh and random, so that old
  /// welcomes cannot be replayed. `is_listed`: see ServerConnection::connected().
  void connected(const Nonce& nonce, const std::optional<ChannelBinding>& binding, TimeUs now_us,
                 bool is_listed = false);
  void disconnected();
  /// Takes one decoded message. After an error wants_close() returns true and a goodbye is queued.
  void receive(Message message, const Arrival& arrival);
  /// Sends pings, repeats requests, and ends a silent connection. Call it about every 10 ms.
  void tick(TimeUs now_us);
  /// Returns the messages to send, in order. Edits may overtake the others, because they have a
  /// class of their own.
  std::vector<Message> take_outgoing() { return connection_.take_outgoing(); }
  /// Returns true if the connection should be closed once what is queued has been sent.
  bool wants_close() const { return connection_.wants_close(); }
  /// Queues a goodbye. wants_close() returns true afterwards.
  void close(GoodbyeReason reason, std::string text) { connection_.close(reason, std::move(text)); }

  /// Shows an edit and offers it to the server. `submitted_us`: the click or the scheduled time;
  /// latency is measured from there. `in_action` is as in LocalEdits::add(): the edits of an action
  /// are undone as one. With the feature large actions, edits beyond the window of the session
  /// are sent when earlier ones are answered. Fails as
  /// Replica::predict() does, and with limit_exceeded if edit_wait_us() is not 0.
  Result<ClientSequence> offer(const EditDescriptor& edit, TimeUs submitted_us, TimeUs now_us,
                               InAction in_action = {});
  /// Returns true if an action may have any number of edits, and budgets delay them at the server.
  bool has_large_actions() const;
  /// Returns true if the edit, as one of an action, would be sent at once.
  bool has_window_for(const EditDescriptor& edit) const;
  /// Returns how long the edit of an action waits for the player's edit budget, so that a part of
  /// the budget is left for clicks.
  TimeUs action_wait_us(const EditDescriptor& edit, TimeUs now_us) {
    return allowance_.wait_us(edit, now_us, EditAllowance::kLeftForClicks);
  }
  /// Returns why offer() has refused this edit with this error, for the player. If the player may
  /// not make the edit, the text names the protected box or the role.
  std::string refusal_text(const EditDescriptor& edit, const Error& error) const;
  /// Returns how long the player's edit budget needs until it suffices for this edit, as far as
  /// this client knows.
  TimeUs edit_wait_us(const EditDescriptor& edit, TimeUs now_us) {
    return allowance_.wait_us(edit, now_us);
  }
  /// Returns true if the server accepts no edits because its disk is full.
  bool is_server_read_only() const { return is_server_read_only_; }
  /// Requests a view; its number is ignored.
  void set_view(const View& view);
  /// Requests the view as it was at a moment of the past, read-only, or as it is now.
  /// `request.request` is ignored. The live world and the views of others do not change. Fails
  /// unless open.
  Result<void> request_history(const HistoryRequest& request);
  /// Returns true if the newest history request was sent, and not everything that it asked for has
  /// arrived.
  bool loading_history() const { return history_.is_loading(); }
  /// Returns why the newest history request was refused, or an empty string.
  const std::string& history_refusal() const { return history_.refusal(); }
  /// Returns the newest request of this connection; its number is 0 if there was none.
  const HistoryRequest& history_request() const { return history_.newest(); }

  /// Sends a command, such as "undo". Fails with
  ///   - bad_value unless open, while another command runs, or if the text is not 1 to
  ///     kCommandBytesMax bytes of UTF-8;
  ///   - unknown_kind if the server accepts no commands.
  Result<void> command(std::string text);
  /// Returns true if a command was sent and its output is not complete.
  bool commanding() const { return is_commanding_; }
  /// Returns the output of the newest command so far. If the connection ended before, a line says
  /// so.
  const std::vector<std::string>& command_lines() const { return command_lines_; }
  /// Returns true if the connection ended before the output of the newest command was complete.
  bool is_answer_lost() const { return is_answer_lost_; }
  /// Returns true if the newest command has completed and succeeded.
  bool command_ok() const { return is_command_ok_; }

  /// Returns what a rollback would change, if the newest command was a preview and its server sent
  /// it. Edits with materials that this client does not know are left out.
  const std::optional<RestorePreview>& restore_preview() const { return restore_preview_; }

  /// Requests the marks that the timeline lacks, if a request is due. Call it while the timeline is
  /// on the screen. Does nothing unless open, and with servers that send no marks.
  void step_timeline(TimeUs now_us);
  const LogTimeline& timeline() const { return timeline_; }
  /// Returns a number that rises with each change of the timeline.
  std::uint64_t timeline_serial() const { return timeline_serial_; }

  /// Follows the voxel at the crosshair, or none with nullopt, and asks who set it last if a
  /// request is due. Does nothing if no world is open, in the past, and if the server cannot name
  /// authors.
  void step_voxel_author(const std::optional<VoxelPos>& at, TimeUs now_us);
  const VoxelAuthor& voxel_author() const { return voxel_author_; }
  /// Returns true if voxel_author().found() may return something else than at the last call.
  bool take_voxel_author_changed() { return voxel_author_.take_changed(); }

  /// Returns true if the server has a library of builds that clients use.
  bool has_library() const;
  /// Returns what this client does with the library. step_library() sends its messages.
  LibraryExchange& library() { return library_; }
  const LibraryExchange& library() const { return library_; }
  /// Sends the messages of library(). Without an open world, and with servers that have no library,
  /// everything that is wanted of it fails. Call it every turn.
  void step_library(TimeUs now_us);

  /// Returns the exchange that gets the textures of the world. tick() sends its messages.
  TextureExchange& textures() { return textures_; }
  const TextureExchange& textures() const { return textures_; }

  /// Sends a line to everybody. Fails with one line of text unless open, if the server has no chat,
  /// or as chat_text() does. The server answers with the line itself, or with one that says why
  /// not.
  Result<void, std::string> chat(std::string_view line);
  /// Returns the lines that arrived since the last call, ChatInbox::kLinesMax at most.
  std::vector<ChatLine> drain_chat() { return chat_.drain(); }
  /// Returns the lines that the server withdrew since the last call.
  std::vector<ChatLineId> take_withdrawn_chat() { return chat_.take_withdrawn(); }

  /// Shares what this player's next click would do; an empty list shares nothing any more. Sends a
  /// message only if it is due and the server has the feature. The stroke of a brush goes to a
  /// server that takes strokes; the edits are then a line along it. Call it every turn.
  void share_preview(const std::vector<EditDescriptor>& edits, TimeUs now_us,
                     const std::optional<BrushStroke>& stroke = std::nullopt);
  /// Returns what the other players share.
  const std::map<AuthorId, SharedPreviews::Shared>& others_previews() const {
    return previews_.others();
  }

  /// Returns the chunks to look up in the cache before the next view is sent, or nullopt if there
  /// are none. The view waits for receive_cache_result(), at most
  /// SessionConfig::cache_wait_us.
  std::optional<CacheLookup> take_cache_lookup();
  /// Takes the result of the oldest lookup that is open: the chunks that the cache found. It may be
  /// late, or of an earlier connection.
  void receive_cache_result(std::vector<KeyedChunk> found, TimeUs now_us);
  /// Returns the world as its server describes it now, or nullopt unless open.
  std::optional<CachedWorld> cached_world() const;
  void set_pose(const Pose& pose) { connection_.set_pose(pose); }
  /// Sets the password, which is sent from the next connection on.
  void set_password(std::shared_ptr<PasswordKeys> password) {
    connection_.set_password(std::move(password));
  }
  bool lacks_password() const { return connection_.lacks_password(); }

  SessionState state() const { return connection_.state(); }
  bool is_open() const { return connection_.is_open(); }
  const std::optional<SessionEnd>& end() const { return connection_.end(); }
  /// Returns the welcome of the current or last connection, or nullopt before the first.
  const std::optional<Welcome>& welcome() const { return connection_.welcome(); }
  /// Returns the newest list of the servers of the world.
  const Servers& servers() const { return connection_.servers(); }
  std::uint64_t servers_number() const { return connection_.servers_number(); }
  /// Returns how often materials of welcome() were given shapes.
  std::uint64_t shapes_number() const { return connection_.shapes_number(); }
  AuthorId author() const { return connection_.author(); }
  // These return what the functions of ServerConnection with the same names return.
  const std::optional<Pose>& place() const { return connection_.place(); }
  std::optional<WorldTime> world_time(TimeUs now_us) const {
    return connection_.world_time(now_us);
  }
  /// Returns the name with which this player joins.
  const std::string& name() const { return connection_.config().name; }
  OperationId operation(ClientSequence seq) const {
    return {author(), connection_.config().instance, seq};
  }
  /// Returns the view in force: the requested one within the server's limits. See
  /// ServerConnection::view().
  View view() const { return connection_.view(); }
  /// Returns the number of chunks in view that the world has. Requires an open session.
  std::size_t view_chunks() const;
  /// Returns true if every chunk in view arrived on this connection or is unavailable, and none
  /// waits to be repaired.
  bool loaded() const;
  /// Returns the number of pongs. If it has risen by two, a ping sent in between has come back.
  std::uint64_t pongs() const { return connection_.pongs(); }
  const ClockOffset& clock() const { return connection_.clock(); }
  const std::map<AuthorId, OtherPlayer>& others() const { return others_; }
  /// Returns a number that rises with each change of others(), except of the poses.
  std::uint64_t players_serial() const { return players_serial_; }
  /// Returns true if a rejected edit, which was offered first with this sequence, waits to be
  /// offered again.
  bool keeps_lost_edit(ClientSequence seq) const { return lost_.has(seq); }
  /// Returns the server keys by world: those configured, and those of worlds seen for the first
  /// time.
  const std::map<WorldId, PublicKey>& pinned() const { return connection_.config().pinned; }
  std::uint64_t connect_count() const { return connection_.connect_count(); }

  /// The replica stays at its address when the session is moved.
  Replica& replica() { return *replica_; }
  const Replica& replica() const { return *replica_; }

 private:
  void on_session_accepted(const SessionAccepted& accepted, TimeUs now_us);
  void on_command_output(CommandOutput output);
  void on_player_list(const PlayerList& list);
  void on_poses(const PlayerPoses& poses);
  void on_view_state(const ViewState& state);
  void on_restore_preview(RestorePreview preview);
  /// Sends the view, or first looks up in the cache the chunks of it that are missing.
  void refresh_view();
  /// Sends the claims of what is held, and then the view.
  void send_view();
  void send_waiting_edits(TimeUs now_us);
  bool fits_window(const EditDescriptor& edit) const;
  void offer_lost_edits(TimeUs now_us);

  ServerConnection connection_;
  std::unique_ptr<Replica> replica_ = std::make_unique<Replica>();
  HistoryRequests history_;
  std::vector<std::pair<Message, Arrival>> early_;  // arrived before SessionAccepted

  std::uint32_t command_ = 0;  // id of the newest command
  bool is_commanding_ = false, is_command_ok_ = false, is_answer_lost_ = false;
  std::vector<std::string> command_lines_;  // kCommandLinesKept at most
  std::optional<RestorePreview> restore_preview_;
  LogTimeline timeline_;
  std::uint64_t timeline_serial_ = 0;
  VoxelAuthor voxel_author_;

  LibraryExchange library_;
  TextureExchange textures_;
  ChatInbox chat_;
  SharedPreviews previews_;

  bool is_server_read_only_ = false;
  EditAllowance allowance_;
  std::vector<ClientSequence> waiting_;  // local edits to send, ascending
  LostEdits lost_;
  // Cache lookups of this connection.
  std::set<ChunkKey> looked_up_;       // keys that were or will be looked up
  std::vector<ChunkKey> lookup_keys_;  // keys of the next lookup
  std::size_t lookups_open_ = 0;       // results that will come
  std::size_t lookups_stale_ = 0;      // results that will come for earlier connections
  std::optional<TimeUs> view_waiting_since_us_;
  TimeUs now_us_ = 0;             // the newest time passed in
  TimeUs opened_us_ = 0;          // when the connection opened
  std::uint32_t tile_rules_ = 0;  // of the server, see SessionAccepted
  std::map<AuthorId, OtherPlayer> others_;
  std::uint64_t players_serial_ = 0;
};

}  // namespace runstone
