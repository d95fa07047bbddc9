// NetSession: one connection: reads frames, verifies messages and hands them on; sends what is queued by
// priority; ends with a numbered goodbye. A peer that breaks a rule ends its own session and nobody else's.
// Threads: the two loops run on the session's strand; send(), reserve_chunk(), fill_chunk(), forget_outside(), close(),
// abort(), handled(), set_encoding() and set_features() may be called from any thread and return at once.
#pragma once
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <asio/strand.hpp>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"
#include "server/limits/token_bucket.hpp"
#include "server/net/byte_stream.hpp"
#include "server/net/chunk_gate.hpp"
#include "server/net/net_events.hpp"
#include "server/net/send_queue.hpp"

namespace runstone {

struct NetLimits {
  SendLimits send;
  std::uint64_t bytes_per_second =
      0;  // per session: terrain waits where more would go; 0: no limit
  std::uint64_t server_bytes_per_second = 0;  // all sessions together, likewise
  std::uint64_t read_bytes_per_second =
      0;  // from each session: beyond it reading pauses; 0: no limit
  std::size_t notsent_bytes = 16 * 1024;  // TCP_NOTSENT_LOWAT
  std::size_t connections_max = 512;      // sockets, in any state
  std::size_t handshakes_per_address =
      32;  // of those sockets: not yet authenticated, from one address
  std::size_t unhandled_bytes_max =
      8 * 1024;  // per session, and 64 for each message; then its reading pauses
  std::uint64_t messages_per_second = 10'000;  // per session; 0: no limit
  std::uint64_t message_burst = 20'000;
  std::int64_t linger_ms = 1'000;  // for the goodbye to leave and the peer to close
};

struct NetCounters {
  std::atomic<std::uint64_t> connections{0}, refused{0}, bytes_in{0}, bytes_out{0}, messages_in{0},
      malformed{0};
  std::atomic<std::int64_t> commit_send_ns{
      0};  // in calls that sent edits class bytes (and what went with them)
  std::atomic<std::uint64_t> commit_sends{0};  // writes of such bytes
  std::atomic<std::uint64_t> commits_due{
      0};  // sessions told of such bytes that have not got to sending them
};

class NetSession : public std::enable_shared_from_this<NetSession> {
 public:
  /// `budget` (of the server), `events` and `counters` must outlive the session. `chunk_edge`: of the world.
  NetSession(SessionId id, asio::io_context& io, std::unique_ptr<ByteStream> stream,
             const NetLimits& limits, std::uint16_t chunk_edge, ByteBudget& budget,
             NetEvents& events, NetCounters& counters);

  SessionId id() const { return id_; }
  const std::string& peer() const { return peer_; }

  /// Tells connected and starts both loops. Once.
  void start();

  /// False: the class is full, nothing was queued. After close() messages vanish and true is returned.
  bool send(const EncodedMessage& message);
  /// Takes a place for a chunk; nothing if the class is full.
  std::optional<ChunkPlace> reserve_chunk(const ChunkKey& key);
  void fill_chunk(ChunkPlace place, const EncodedMessage& message);
  /// Snapshots outside of the view that nothing was sent of need not be sent.
  void forget_outside(const View& view);
  void set_encoding(ChunkEncoding encoding) { encoding_.store(encoding); }
  ChunkEncoding encoding() const { return encoding_.load(); }
  /// The optional parts of the protocol that are in force. Once, before the first chunk.
  void set_features(std::uint64_t features);

  /// Sends goodbye after the edits and control messages queued, drops chunks, closes; at the latest after the
  /// linger time. Only the first call counts.
  void close(GoodbyeReason reason, const std::string& text);
  void handled(std::size_t message_bytes);
  /// Closes without a goodbye and without waiting for the peer.
  void abort();

 private:
  using Strand = asio::strand<asio::io_context::executor_type>;
  static asio::awaitable<void> read_loop(std::shared_ptr<NetSession> self);
  static asio::awaitable<void> write_loop(std::shared_ptr<NetSession> self);
  static asio::awaitable<void> end_after_linger(std::shared_ptr<NetSession> self);
  Result<void> on_message(FrameClass frame_class, ByteView body);
  Result<void> on_received(const ReceiveAck& received);
  void refuse(const Error& error);
  asio::awaitable<void> wait_for_turn(std::size_t bytes_read);
  bool must_pause() const { return unhandled_.load() >= limits_.unhandled_bytes_max; }
  bool has_chunk();
  void wake_writer();
  /// Whether the writer has to be told that there is something to send. Under the mutex.
  bool take_wake();
  void post_wake();
  void loop_ended();

  const SessionId id_;
  const NetLimits& limits_;
  const std::uint16_t chunk_edge_;
  NetEvents& events_;
  NetCounters& counters_;
  Strand strand_;
  std::unique_ptr<ByteStream> stream_;
  std::string peer_;
  std::atomic<ChunkEncoding> encoding_{ChunkEncoding::raw};
  std::atomic<std::size_t> unhandled_{0};  // bytes, see NetLimits
  std::atomic<bool> reader_paused_{false};

  std::mutex mutex_;  // a leaf: guards the next six
  SendQueue queue_;
  ChunkGate gate_;
  bool closing_ = false;
  bool writer_idle_ = false;
  bool is_woken_ = false;  // told, and has not run yet
  bool is_due_ = false;    // counted in commits_due

  // On the strand from here on.
  asio::steady_timer write_wake_, read_wake_, read_turn_, linger_;
  ByteBudget read_budget_;
  FrameReader reader_;
  TokenBucket messages_;
  GoodbyeReason broken_rule_ = GoodbyeReason::malformed_frame;  // by the error that feed() returns
  int loops_ = 0;
  bool linger_started_ = false;
};

}  // namespace runstone
