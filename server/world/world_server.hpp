// WorldServer: the interface of the world strand. Everything that happens to the world is a call of
// it, with the time as an argument; everything that it wants done is a call of WorldEnvironment. It
// uses no clock, socket, disk or thread, so a test runs it in virtual time. Call received() for
// each message that arrived, then commit() once: edits that were queued together become one commit.
// Call tick() some 20 times a second.
// Threads: all calls on one strand. WorldEnvironment must not call in; its answers come as later
// calls.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/address_block.hpp"
#include "common/edits/apply/stack_depths.hpp"
#include "common/rights/change_rules.hpp"
#include "protocol/codec/messages.hpp"
#include "server/limits/recent_refusals.hpp"
#include "server/world/added_at.hpp"
#include "server/world/clocks.hpp"
#include "server/world/following.hpp"
#include "server/world/handover.hpp"
#include "server/world/server_edits.hpp"
#include "server/world/world_config.hpp"
#include "server/world/world_counters.hpp"
#include "server/world/world_environment.hpp"

namespace runstone {

struct WorldState;

class WorldServer {
 public:
  /// `environment` must outlive the server.
  WorldServer(WorldConfig config, const WorldStart& start, WorldEnvironment& environment,
              RandomBytes random);
  ~WorldServer();
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  /// Replays a record of the log above the checkpoint. Call it for each, in order, before the first
  /// session.
  void replay_onto_stack(const EditRecord& record);

  // Sessions.
  /// Adds a connection from this address. `binding` identifies it if it is encrypted.
  void connected(SessionId session, const Clocks& now, AddressBlock from = {},
                 const std::optional<ChannelBinding>& binding = std::nullopt);
  /// Handles a verified message. Closes the session if its stage does not allow the message:
  /// not_authenticated before session accepted, unexpected_message otherwise. Ignores messages of
  /// closed sessions.
  void received(SessionId session, Message&& message, const Clocks& now);
  void disconnected(SessionId session);
  /// Reports that the session's queues have room again.
  void drained(SessionId session, const Clocks& now);

  // Progress.
  /// Returns true if commit_one() would order edits. Some large edits that are queued may have to
  /// wait (LargeEditPace).
  bool has_ready_edits(TimeUs now_us) const;
  /// Orders and sends the queued edits of one commit. Others that are queued may follow later.
  void commit_one(const Clocks& now);
  /// Takes over what may change while the world runs: sessions of a key and of an address, the time
  /// without a message, reach, speed, the operators and the message of the day. Sessions that are open
  /// stay.
  void reconfigure(const WorldConfig& config);
  /// Orders and sends queued edits as long as has_ready_edits().
  void commit(const Clocks& now);
  /// Returns true if the chunks of a session are to be sent by deliver_next().
  bool has_deliveries() const;
  /// Sends some chunks of one session. Sessions take turns.
  void deliver_next(const Clocks& now);
  /// Returns true if changed tiles wait to be sent. Then call resend_tiles() after kTileResendBurstUs
  /// (tile_resends.hpp).
  bool has_tile_resends() const;
  void resend_tiles(const Clocks& now);
  /// Does periodic work: timeouts, views, presence, digest checks, retries, checkpoints and
  /// eviction.
  void tick(const Clocks& now);

  // Edits of the server: rollback, undo, redo.
  /// See server_edits.hpp.
  ServerEditsResult order_server_edits(const std::vector<EditOffer>& offers, AuthorId payer,
                                       const Clocks& now);

  // Commands.
  /// Sends output of the session's command under way, as lines. `is_done` ends the command. Ignored
  /// if the session is closed.
  void answer_command(SessionId session, const std::vector<std::string>& lines, bool is_done,
                      bool is_ok);
  struct OnlinePlayer {
    SessionId session = 0;
    AuthorId author = 0;
    std::string name;
    PublicKey key{};
    WorldPos at;
  };
  /// Returns the players with open sessions, ordered by session.
  std::vector<OnlinePlayer> online_players() const;
  /// Returns the players of this run that left without an edit, as Players::visitors() keeps them.
  std::vector<PlayerRow> visitors() const;
  /// Returns the names that keys own, ascending by folded form.
  std::vector<NameClaim> name_claims() const;
  /// Returns the author number of a key, or nullopt if it has none.
  std::optional<AuthorId> author_of(const PublicKey& key) const;
  /// Frees a name. Returns the claim that it had, or the reason why nothing changed.
  Result<NameClaim, std::string> release_name(const std::string& name);

  // Materials.
  /// Returns the material table in force.
  const MaterialTable& materials() const;
  /// See material_handlers.hpp.
  Result<AddedAt, MaterialsRefusal> add_materials(const std::vector<MaterialRow>& rows,
                                                  const Clocks& now);

  // Rights.
  const RightsState& rights() const;
  /// Returns the time by which restrictions end (UTC).
  TimeUs rights_time() const;
  /// Returns the sequence of the last change of rights in this run, or 0.
  Sequence newest_rights() const;
  /// Returns why the change would be refused, as a sentence, or nullopt.
  std::optional<std::string> change_refusal(const RightsChange& change,
                                            const RightsActor& actor) const;
  /// Orders a change of rights as a record of the log, made by the author (0: the console), who pays
  /// for it as for an edit. Sessions that may not stay are closed. Returns its sequence, or why it
  /// was refused, as a sentence.
  Result<Sequence, std::string> change_rights(const RightsChange& change, const RightsActor& actor,
                                              AuthorId author, const Clocks& now);
  /// Returns what players were refused lately, the newest last.
  std::vector<RefusalRow> refusals() const;
  /// Sends a line of the host to everybody. `by` and the requirement: see chat_handlers.hpp. Returns
  /// the number of sessions that get it.
  std::size_t say(const std::string& text, const PublicKey& by, const Clocks& now);
  /// Returns a random number for a new invite.
  InviteId new_invite_id();
  /// Returns the link with which players accept an invite.
  std::string invite_link(InviteId invite) const;
  /// Closes the sessions of a key, or of a range of addresses. Returns their number.
  std::size_t kick(const RestrictionSubject& who, const std::string& reason);
  /// See command_handlers.hpp.
  std::optional<View> restore_preview_view(SessionId session) const;
  void show_restore(SessionId session, const RestorePreview& preview);
  /// Returns why the author may not make this edit, or nullopt. The server (0) may make every edit.
  std::optional<std::string> edit_refusal(AuthorId author, const EditDescriptor& edit) const;

  // Answers of WorldEnvironment.
  void chunk_loaded(const ChunkKey& key, Chunk chunk, const Clocks& now);
  /// Quarantines a damaged chunk. Loads one that could not be read again later, a few times.
  /// `what` names file, table and row.
  void chunk_failed(const ChunkKey& key, LoadFailure failure, const std::string& what,
                    const Clocks& now);
  /// Brings a requested tile, the last one of `made`, and tiles that were made on the way to it.
  /// `made` is empty if it could not be made.
  void tiles_made(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now);
  /// Brings tiles that were made on the way to a requested one, before the request reached
  /// TileRequest::steps_max. The tile is requested again.
  void tile_stopped(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now);
  /// The same for a request of WorldEnvironment::make_past_tile().
  void past_tile_made(SessionId session, const TileRequest& request,
                      const std::vector<MadeTile>& made, const Clocks& now);
  void past_tile_stopped(SessionId session, const TileRequest& request,
                         const std::vector<MadeTile>& made, const Clocks& now);
  /// Answers a session's history request, with the reason if it failed.
  void history_opened(SessionId session, std::uint32_t request,
                      const Result<OpenedHistory, std::string>& opened, const Clocks& now);
  /// Brings a chunk of the past for this history view. The error names file, table and row.
  void history_chunk_loaded(SessionId session, HistoryNumber history, const ChunkKey& key,
                            const Result<ChunkPtr, std::string>& chunk, const Clocks& now);
  /// Answers a session's request for marks of the log. The error is for the client.
  void log_marks_read(SessionId session, std::uint32_t request,
                      const Result<FoundLogMarks, std::string>& found, const Clocks& now);
  /// Reports that every edit up to `seq` is on disk.
  void durable(Sequence seq, const Clocks& now);
  /// Reports that so many more changes of names are on disk, the oldest first.
  void names_durable(std::size_t count, const Clocks& now);
  /// Reports that the oldest unanswered save_snapshots() is on disk.
  void snapshots_saved(const Clocks& now);
  /// Reports that the disk has no space for new edits, or has space again. Edits are rejected busy
  /// meanwhile.
  void set_disk_is_full(bool is_full, const Clocks& now);
  /// Reports that the log cannot be written any more. Edits are rejected busy from now on.
  void log_failed();

  // Several servers of one world (followers.hpp, following.hpp).
  /// From now on another server owns the world, and this one follows it. Call it before the first
  /// session, after replay_onto_stack().
  void follow();
  bool is_following() const;
  /// Returns true if this server is the owner, and no other one can be it.
  bool owns_world() const;
  /// Returns false if this server follows, and has not reached the owner.
  bool is_live() const;
  /// Returns true if this server has edits that the log does not have. It cannot go on then.
  bool has_forked() const;
  /// Returns the last record that this server has.
  Version last_record() const;
  /// Returns when this server last heard the owner that it follows, by the steady clock, or nullopt if
  /// it is not connected with one.
  std::optional<TimeUs> owner_heard_us() const;
  /// Returns the number of servers that follow this one.
  std::size_t follower_count() const;
  /// See handover.hpp. Requires that this server owns the world.
  std::vector<KnownServer> known_servers() const;
  // The connection with the owner. Ignored unless is_following().
  void owner_connected(const std::optional<ChannelBinding>& binding, const Clocks& now);
  void owner_received(Message&& message, const Clocks& now);
  void owner_disconnected();
  void log_read(const Result<ReadLog, std::string>& read, const Clocks& now);
  /// Reports that the owner has moved the checkpoint: every edit up to it is contained in snapshots.
  void checkpoint_moved(Sequence checkpoint);
  /// Stops following, because the caller has the lease of the world. Players stay; what they do waits.
  /// Returns the parts of the log that the earlier owner may not have written, in order. The caller
  /// writes those whose records the log lacks, then calls take_over().
  std::vector<LogPart> stop_following();
  /// Makes this server the owner. Sessions go on, and edits that wait are ordered. Returns false if the
  /// log has other edits than this server: nothing may be written then.
  bool take_over(const Takeover& start, const Clocks& now);

  // Handover (handover.hpp).
  /// Returns why the world cannot be handed over to this server (nullopt: to any), as a sentence, or
  /// nullopt.
  std::optional<std::string> handover_refusal(std::optional<SessionId> successor) const;
  /// Makes the owner a server that follows. Sessions go on, and their edits wait. The caller then writes
  /// the log, calls handover_written(), and gives the lease up. Reports about the log may come until
  /// then. Returns the number of the server that is to take the world over. Requires that
  /// handover_refusal() returns nullopt.
  SessionId hand_over(std::optional<SessionId> successor, const Clocks& now);
  void handover_written(const Clocks& now);
  /// Returns the server to which the owner should hand the world over now, or nullopt. Returns each
  /// answer once. Players may make their edits elsewhere then (OwnerChoice).
  std::optional<SessionId> take_better_owner();

  // Stop.
  /// Closes all sessions, rejects edits, and writes dirty chunks as snapshots for at most
  /// stop_us_max. It continues with the answers of WorldEnvironment and with tick() until
  /// is_flushed().
  void begin_stop(const Clocks& now);
  /// Returns true if every ordered edit is durable and either contained in snapshots, except those
  /// of quarantined chunks, or left to the next start because is_stop_overdue().
  bool is_flushed() const;
  /// Returns true if a stop is under way, and another server waits to take the world over.
  bool hands_over() const;
  /// Returns true if a stop is under way and begins no more snapshots.
  bool is_stop_overdue() const;
  /// Returns the number of chunks with edits that only the log has. Quarantined chunks do not
  /// count.
  std::size_t dirty_chunks() const;

  // State.
  /// Returns false if the server stops, the log has failed, or another server owns the world.
  bool accepts_edits() const;
  /// Returns true if an accepted edit of the author is not ordered yet: a large edit, or one behind
  /// it, waits until there is room to send it (EditQueue).
  bool has_waiting_edit(AuthorId author) const;
  Epoch epoch() const;
  Sequence head() const;
  /// Returns the highest resolved client sequence of the instance, 0 if there is none.
  ClientSequence resolved(AuthorId author, ClientInstance instance) const;
  Sequence durable() const;
  Sequence checkpoint() const;
  /// Returns the number of sessions in any stage.
  std::size_t session_count() const;
  std::size_t resident_chunks() const;
  WorldMemory memory() const;
  const WorldCounters& counters() const;
  /// See Authority::edit_waits().
  const WaitHistogram& edit_waits() const;
  /// Returns the depths of the edit stacks that were applied.
  const StackDepths& stack_depths() const;
  /// Returns null unless the chunk is in memory.
  ChunkPtr find_chunk(const ChunkKey& key) const;
  /// Returns all chunks in memory that were ever edited, ascending.
  std::vector<std::pair<ChunkKey, ChunkPtr>> edited_chunks() const;
  /// Returns the version of a chunk, in memory or not.
  Version chunk_version(const ChunkKey& key) const;

 private:
  void step_checkpointer(const Clocks& now);
  std::unique_ptr<WorldState> state_;
};

}  // namespace runstone
