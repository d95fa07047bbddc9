// ServerCore: connects the parts of a running server around the world strand and starts and stops
// them. It turns events of sessions and timers into calls of WorldServer. ServerEnvironment is the
// other direction.
// Threads: I/O threads run the strands; workers load, generate and encode chunks; decoders decode
// large messages; readers and the log writer have threads of their own. The world and the connected
// sessions belong to the world strand.
#pragma once
#include <asio/io_context.hpp>
#include <asio/thread_pool.hpp>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/admin/server_config.hpp"
#include "server/history/chunk_source.hpp"
#include "server/net/gateway_listener.hpp"
#include "server/net/listener.hpp"
#include "server/runtime/activity_line.hpp"
#include "server/runtime/chat_logging.hpp"
#include "server/runtime/chunk_sender.hpp"
#include "server/runtime/clock_check.hpp"
#include "server/runtime/command_runner.hpp"
#include "server/runtime/commit_scheduler.hpp"
#include "server/runtime/connected_sessions.hpp"
#include "server/runtime/durable_log.hpp"
#include "server/runtime/health_watch.hpp"
#include "server/runtime/message_turns.hpp"
#include "server/runtime/owner_connection.hpp"
#include "server/runtime/page_desk.hpp"
#include "server/runtime/periodic_task.hpp"
#include "server/runtime/server_environment.hpp"
#include "server/runtime/stop_state.hpp"
#include "server/runtime/tile_making.hpp"
#include "server/runtime/world_readers.hpp"
#include "server/runtime/world_strand.hpp"
#include "server/store/world_folder.hpp"
#include "server/world/order/ownership.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// The threads of a server. Workers and decoders have a lower priority than the others.
struct ServerThreads {
  asio::io_context& io;
  asio::thread_pool& workers;   // must have ended when the core is destroyed
  asio::thread_pool& decoders;  // must not end before the threads of `io`
};

class ServerCore final : public NetEvents {
 public:
  /// The core keeps references to the members of `threads`, and to `config`, `store` and
  /// `generator`. All of them must outlive it. `store` is open at world_place(config). `on_failure`
  /// is called at most once, from the log writer's thread, when the log cannot be written any more.
  /// `actions`: the commands that the program carries out.
  ServerCore(const ServerThreads& threads, const ServerConfig& config, Store& store,
             const Generator& generator, std::function<void()> on_failure, OperatorActions actions);
  ~ServerCore() override;

  /// Binds the address. Does not touch the world.
  Result<void, std::string> listen(const std::string& address) {
    return listener_->listen(address);
  }
  /// Makes the Unix socket for a gateway. Does not touch the world.
  Result<void, std::string> listen_for_gateway(const std::string& path, bool is_for_group);
  /// Encrypts connections from now on. Without this call they are not encrypted. Thread: any.
  void set_tls(const TlsContext& tls) { listener_->set_tls(tls); }
  /// Reads what the store remembers, raises the epoch, replays the log above the checkpoint, and
  /// starts the log writer.
  Result<void, std::string> recover();
  /// Reads what the store remembers, and follows the owner of the world. Then call connect_to()
  /// with the address of the owner.
  Result<void, std::string> follow();
  /// Connects to the owner at HOST:PORT, unless there is a connection. Thread: any.
  void connect_to(const std::string& address) { owner_.connect_to(address); }
  /// Makes a server that follows the owner of the world, which `store` has open for writing.
  /// `store` must outlive the core. `address`: where the other servers connect to this one. Blocks
  /// on the database. Sessions go on. After an error the server must be stopped. Requires start().
  /// Thread: any but those of `threads`.
  Result<void, std::string> take_over(Store& store, const std::string& address);
  /// Makes the owner a server that follows: begin_handover(), then end_handover(), then the caller
  /// gives the lease up. Sessions go on. take_over() may follow. `successor` is as for
  /// Cluster::hand_over(). Returns the server that is to take the world over, or why nothing
  /// has changed. Requires start(). Blocks. Thread: any but those of `threads`.
  Result<SessionId, std::string> begin_handover(std::optional<SessionId> successor);
  /// Writes the log and ends the log writer. After an error the server must be stopped. Requires
  /// what begin_handover() requires.
  Result<void, std::string> end_handover();
  /// Returns the part that this server plays in its world. Thread: any.
  OwnershipState ownership() const { return world_->order().ownership().state(); }
  /// The state of the connection with the owner, for a server that follows.
  struct FollowState {
    bool is_live = false;      // it has reached the owner
    bool hears_owner = false;  // it is connected with an owner that does not stand still
  };
  /// Thread: any.
  FollowState follow_state() const;
  /// Accepts sessions and ticks from now on. Requires listen(), and recover() or follow().
  void start();
  std::uint16_t port() const { return listener_->port(); }

  /// Stops in this order: no new connections; a goodbye to each session; every accepted edit is
  /// ordered and made durable; changed chunks are written as snapshots, for at most `stop_s`.
  /// Blocks until this is done, or the log has failed, or the disk is full and `stop_s` is over.
  /// Returns true if another server waits to take the world over. Thread: any but those of
  /// `threads`.
  bool stop_world();
  /// Ends the readers, the log of the chat, the keyframe thread and the log writer, which writes
  /// what is queued. Requires stop_world().
  void stop_writer();
  /// Returns what the stop has left undone. Requires stop_writer(), and that no thread runs the
  /// strand any more.
  StopState stop_state() const;
  /// Returns the edited chunks in memory, ascending. Requires that no thread runs the strand any
  /// more.
  std::vector<std::pair<ChunkKey, ChunkPtr>> edited_chunks() const {
    return world_->order().chunks().edited();
  }
  /// Returns true if no role was ever granted and no invite ever made. Requires recover(), and that
  /// no thread runs the strand yet.
  bool is_unclaimed() const { return !world_->rights().state().has_ever_granted(); }
  /// Writes one line of all counters at info. Thread: any.
  void log_counters();
  /// Carries out a command of the console or the control socket. The replies come on the world
  /// strand. Thread: any.
  void command(const std::string& line, CommandReply reply);
  /// What the operators' page needs of this server. The functions may be called from any thread.
  PageDesk::Server page_server();
  /// Carries out a command, and returns its last answer. Blocks. Thread: any but those of
  /// `threads`.
  CommandAnswer answer_of(const std::string& line);

  /// Answers a question of a gateway, of which there is one: "status". The answer is the line of
  /// all counters (counters_line.hpp), a line "version V", a line "read_only WHY" if edits are
  /// refused, and the lines "player NAME" and "place X Y Z NAME" for each session. Thread: any.
  void answer_gateway(const std::string& question, CommandReply reply);

  /// Takes over the settings that a running server may change, logs which, and replies. `read` is
  /// the new configuration, or why there is none. Thread: any.
  void reload(Result<ServerConfig, std::string> read, CommandReply reply);

  // NetEvents: called on session strands.
  void on_refused(SessionId session) override;
  void on_connected(SessionId session, const std::optional<ChannelBinding>& binding) override;
  void on_message(SessionId session, Message&& message, std::size_t bytes) override;
  void on_drained(SessionId session) override;
  void on_disconnected(SessionId session) override;

 private:
  /// Makes the world of what `store` remembers, and adds the chat to `start`.
  Result<void, std::string> make_world(WorldStart& start);
  /// Makes the log writer and, the first time, the commands.
  void make_log(Store& store, Sequence durable);
  LogWriter::Counters log_counters_now() const;
  /// Reads how far the owner's snapshots reach.
  void read_checkpoint();
  DurableLog::Events log_events();
  void tick();
  /// Hands the world over for `move_to_builders`.
  void hand_over_to(SessionId successor);
  /// Closes the sessions whose clients have read nothing for the idle time.
  void close_stalled();
  /// Runs after every task of the world strand.
  void after_task();
  /// Posts a task that handles the next message, unless none waits or the task is posted already.
  /// It is posted again while messages wait. Tasks that were posted in between run first, so that
  /// later messages take part in the turns.
  void schedule_turn();
  void handle(MessageTurns::Turn&& turn);
  /// Posts a task that sends chunks, if a session's delivery is not complete, unless it is posted
  /// already.
  void schedule_delivery();
  void schedule_tile_resends();
  /// Ends the timers if the stop that is under way has nothing more to wait for. Returns nullopt if
  /// it has, otherwise true if another server waits to take the world over.
  std::optional<bool> finish_stop();
  std::string all_counters(std::uint64_t memory_bytes) const;
  ServerHealth health() const { return health_.health(log_ ? log_->log_bytes() : std::nullopt); }
  RetentionState retention_state() const;
  /// Returns the answer to the command `status` at a server that follows.
  std::string status_of_follower() const;
  /// Logs what happened since the last call, if anything did.
  void write_activity();

  asio::io_context& io_;
  const ServerConfig& config_;
  Store& store_;  // of a server that follows: for reading
  const Generator& generator_;
  const std::function<void()> on_failure_;
  const OperatorActions actions_;
  ClockEvidence clock_evidence_;  // of the start
  ServerConfig running_;          // config_ with what was reloaded. Used on the world strand
  WorldStrand strand_;
  std::shared_ptr<Listener> listener_;
  std::shared_ptr<GatewayListener> gateway_;  // null: there is no gateway
  ConnectedSessions sessions_;
  MessageTurns messages_;                                     // used on the world strand
  bool is_turn_posted_ = false, is_delivery_posted_ = false;  // used on the world strand
  ChunkSource chunks_;
  ChunkSender sender_;
  WorldReaders readers_;
  TileMaking tiles_;
  OwnerConnection owner_;
  ServerEnvironment environment_;
  CommitScheduler commits_;
  HealthWatch health_;
  asio::steady_timer tile_resends_;   // Ground::resend_tiles()
  bool is_resend_scheduled_ = false;  // used on the world strand
  PeriodicTask ticks_, stalls_, activity_, chat_retention_, checkpoints_;
  // Written by the world strand. The time is Cluster::owner_heard_us(), 0 without a connection.
  std::atomic<bool> is_live_{false};
  std::atomic<TimeUs> owner_heard_us_{0};
  ActivitySample sampled_;  // at the last write_activity(). Used on the world strand

  LogWriter::Counters ended_logs_;  // of the earlier periods in which this server owned the world

  // These parts exist from recover() or follow() on. Of a server that follows, the log exists only
  // while it owns the world, and the commands from the first time on.
  std::unique_ptr<ChatLog> chat_log_;  // null if chat_days is 0
  std::unique_ptr<WorldServer> world_;
  std::unique_ptr<DurableLog> log_;
  std::unique_ptr<CommandRunner> commands_;
};

}  // namespace runstone
