// ServerCore: the world strand with its surroundings: it turns what sessions, workers and the log writer tell
// into calls of WorldServer on one strand, and carries out what WorldServer asks for by WorldEnvironment. Threads:
// I/O threads run the strands; workers load, generate and encode; the log writer has its own. `sessions_` and
// everything of the world belong to the world strand.
#pragma once
#include <array>
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <asio/strand.hpp>
#include <asio/thread_pool.hpp>
#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "server/admin/command_handler.hpp"
#include "server/admin/server_config.hpp"
#include "server/history/moments.hpp"
#include "server/limits/token_bucket.hpp"
#include "server/net/listener.hpp"
#include "server/runtime/chunk_source.hpp"
#include "server/runtime/encoded_chunks.hpp"
#include "server/runtime/keyframe_thread.hpp"
#include "server/store/log_writer.hpp"
#include "server/store/world_folder.hpp"
#include "server/world/commit_pace.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

class ServerCore final : public WorldEnvironment,
                         public NetEvents,
                         public RollbackService::Workers {
 public:
  /// `io` and `workers` must outlive the core. `on_failure` is called at most once, from the log writer's
  /// thread; `on_stop` from the world strand, when an operator asks for it.
  ServerCore(asio::io_context& io, asio::thread_pool& workers, const ServerConfig& config,
             Store& store, const Generator& generator, std::function<void()> on_failure,
             std::function<void()> on_stop);
  ~ServerCore() override;

  /// Binds the address; the world is not touched yet.
  Result<void, std::string> listen(const std::string& address) {
    return listener_->listen(address);
  }
  /// Raises the epoch, reads what the store remembers, restacks the log above the checkpoint, starts the log
  /// writer.
  Result<void, std::string> recover(const std::string& folder);
  /// Accepts sessions and ticks from now on.
  void start();
  std::uint16_t port() const { return listener_->port(); }

  /// Ends in this order: no new connections, goodbyes, what was accepted is ordered and durable, changed
  /// chunks are snapshots. Ready with true when all of it is on disk, with false if the log failed.
  std::future<bool> begin_stop();
  /// After begin_stop()'s answer: ends previews and the making of keyframes, writes what is queued and ends the writer's thread.
  void stop_writer();
  /// Edited chunks in memory, ascending. Once no thread runs the strand any more.
  std::vector<std::pair<ChunkKey, ChunkPtr>> edited_chunks() const {
    return world_->edited_chunks();
  }
  bool has_failed() const { return failed_.load(); }
  /// One line at info. Any thread.
  void log_counters();
  /// Carries out a command of the console or of control. Any thread; the replies come on the world strand.
  void command(const std::string& line, CommandReply reply);

  // ---- NetEvents, on session strands
  void on_connected(SessionId session) override;
  void on_message(SessionId session, Message&& message, std::size_t bytes) override;
  void on_drained(SessionId session) override;
  void on_disconnected(SessionId session) override;

  // ---- WorldEnvironment, on the world strand
  bool send(SessionId session, const EncodedMessage& message) override;
  std::vector<SessionId> send_to_all(std::span<const SessionId> sessions,
                                     const EncodedMessage& message) override;
  void set_encoding(SessionId session, ChunkEncoding encoding) override;
  void set_features(SessionId session, std::uint64_t features) override;
  void opened(SessionId session) override;
  bool send_snapshot(SessionId session, const ChunkKey& key, const ChunkPtr& chunk) override;
  bool send_update(SessionId session, const ChunkKey& key, const ChunkPtr& chunk,
                   Version held) override;
  void forget_outside(SessionId session, const View& view) override;
  void close(SessionId session, GoodbyeReason reason, const std::string& text) override;
  bool log_has_room(std::size_t records) const override;
  void log_append(std::vector<PlayerRow> players, std::vector<EditRecord> records) override;
  void load_chunk(const ChunkKey& key) override;
  void open_moment(SessionId session, const HistoryRequest& travel) override;
  void load_past_chunk(SessionId session, std::uint32_t request, Sequence at,
                       const ChunkKey& key) override;
  void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                      Sequence checkpoint) override;
  void command(SessionId session, AuthorId author, const PublicKey& key,
               const std::string& text) override;
  void log(WorldLogLevel level, const std::string& line) override;

  // ---- RollbackService::Workers, on the world strand
  void run(Work work, std::function<void(std::string)> then) override;

 private:
  static constexpr std::size_t kLogReaders = 2;
  static constexpr std::size_t kPastReaders = 2;
  /// Lines of one level, which peers can cause: ten a second; the next one says how many were left out.
  struct PeerLines {
    TokenBucket bucket{10, 10};
    std::uint64_t left_out = 0;
    /// How many were left out before this line; nothing if it is left out itself.
    std::optional<std::uint64_t> take(TimeUs now_us) {
      if (bucket.take(1, now_us)) return std::exchange(left_out, 0);
      ++left_out;
      return std::nullopt;
    }
  };
  WorldConfig world_config(const ServerConfig& config) const;
  Result<WorldStart, std::string> read_start();
  void start_writer(const std::string& folder);
  void schedule_commit();
  void commit_now();
  void schedule_tick();
  void check_settled();
  NetSession* find(SessionId session);

  asio::thread_pool& workers_;
  const ServerConfig& config_;
  Store& store_;
  const Generator& generator_;
  std::function<void()> on_failure_;
  PeerLines warnings_, infos_;  // of the world strand
  asio::strand<asio::io_context::executor_type> strand_;
  asio::steady_timer tick_, gather_;
  std::shared_ptr<Listener> listener_;
  std::unique_ptr<ChunkSource> chunks_;
  EncodedChunks encoded_;
  std::unique_ptr<Moments> moments_;
  std::unique_ptr<WorldServer> world_;
  std::unique_ptr<LogWriter> writer_;
  std::unique_ptr<KeyframeThread> keyframes_;  // none if the configuration wants none

  std::unique_ptr<RollbackService> rollback_;
  std::unique_ptr<CommandHandler> commands_;
  std::function<void()> on_stop_;
  // They read the log for people who wait; chunks to be loaded or sent never wait for them.
  asio::thread_pool log_readers_{kLogReaders};
  asio::thread_pool past_readers_{
      kPastReaders};  // chunks of the past: travellers wait for each other alone

  std::atomic<Sequence> durable_{0};
  std::atomic<bool> durable_posted_{false};
  std::atomic<bool> failed_{false};

  // On the world strand from here on.
  std::unordered_map<SessionId, std::shared_ptr<NetSession>> sessions_;
  bool commit_posted_ = false;
  CommitPace commit_pace_;
  std::int64_t enqueue_ns_ = 0;  // processor time of send_to_all(), without the sending itself
  TimeUs counters_us_ = 0;
  std::optional<std::promise<bool>> stopped_;  // while begin_stop() waits for its answer
  bool has_stopped_ = false;
};

}  // namespace runstone
