// NetSession: one connection, with a client or with a server. It reads frames, verifies messages
// and reports them to NetEvents; it sends queued messages by priority; it ends with a numbered
// goodbye. A client that breaks a rule ends its own session only.
// Bounds: NetLimits. Another server of the same world is trusted: TrustedLimits hold instead, and
// it may send messages and bytes at any rate.
// Threads: the two loops run on the session's strand. A read that may complete a large message is
// decoded on a thread of `decoders`, so that the I/O threads are free for the small messages of
// others; the read loop waits for it. send(), reserve_chunk(), fill_chunk(),
// forget_outside(), close(), abort(), handled(), trust(), set_encodings() and set_features() may be
// called from any thread and return at once.
#pragma once
#include <asio/any_io_executor.hpp>
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <asio/strand.hpp>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/core/channel_binding.hpp"
#include "common/core/ids.hpp"
#include "common/core/token_bucket.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/session_encodings.hpp"
#include "server/net/byte_stream.hpp"
#include "server/net/chunk_gate.hpp"
#include "server/net/send_queue.hpp"

namespace runstone {

/// The events of network sessions. For each session: either on_refused() alone, or on_connected(),
/// then messages and drains, then on_disconnected() exactly once.
/// Threads: the session's strand, one call at a time for each session. A call must return soon.
class NetEvents {
 public:
  virtual ~NetEvents() = default;
  /// Reports that the connection ended before it was ready: the TLS handshake failed.
  virtual void on_refused(SessionId session) = 0;
  /// Reports that messages can be exchanged. `binding` identifies an encrypted connection.
  virtual void on_connected(SessionId session, const std::optional<ChannelBinding>& binding) = 0;
  /// Brings a verified message of `bytes` bytes. The receiver must call NetSession::handled(bytes)
  /// when it has handled the message, from any thread. A session with too many unhandled bytes
  /// stops reading, and TCP makes the client wait.
  virtual void on_message(SessionId session, Message&& message, std::size_t bytes) = 0;
  /// Reports that the queues have room again after a send that did not fit.
  virtual void on_drained(SessionId session) = 0;
  virtual void on_disconnected(SessionId session) = 0;
};

struct NetLimits {
  SendLimits send;
  // Bytes a second, for each session and for all together. Terrain beyond waits. 0: no limit.
  std::uint64_t bytes_per_second = 0;
  std::uint64_t server_bytes_per_second = 0;
  // Bytes a second from each session, and from all sessions of an address. Beyond it, reading
  // pauses. 0: no limit.
  std::uint64_t read_bytes_per_second = 0;
  std::uint64_t read_bytes_per_address = 0;
  std::size_t notsent_bytes = 16 * 1024;  // TCP_NOTSENT_LOWAT
  std::size_t connections_max = 512;      // sockets, in any state
  // Connections a second of one address; 0: no limit.
  std::uint64_t connections_per_second = 0;
  // Sockets of one address that have not authenticated yet.
  std::size_t handshakes_per_address = 32;
  // Unhandled bytes for each session; each message counts 64 more. Beyond it, reading pauses.
  std::size_t unhandled_bytes_max = 8 * 1024;
  std::uint64_t messages_per_second = 10'000;  // per session; 0: no limit
  std::uint64_t message_burst = 20'000;
  std::int64_t handshake_ms = 10'000;  // for the TLS handshake
  std::int64_t linger_ms = 1'000;      // for the goodbye to be sent and the client to close
  AddressForm log_addresses = AddressForm::full;
};

/// The bounds of a session with another server of the same world, in place of those in NetLimits.
/// They are sized for bursts: a follower gets the records of everything that all players do.
struct TrustedLimits {
  static constexpr std::size_t kEditBytes = 64 * 1024 * 1024;  // of the send queue
  static constexpr std::size_t kEditCount = 256 * 1024;
  static constexpr std::size_t kControlCount = 16 * 1024;
  static constexpr std::size_t kUnhandledBytes = 4 * 1024 * 1024;
};

struct NetCounters {
  std::atomic<std::uint64_t> connections{0}, refused{0}, bytes_in{0}, bytes_out{0}, messages_in{0},
      malformed{0};
  // The parts of bytes_out that are frames of the classes chunks and edits, before encryption.
  std::atomic<std::uint64_t> chunk_bytes_out{0}, edit_bytes_out{0};
  // Processor time of writes that sent bytes of commits, with the cutting into frames and encryption,
  // and the number of these writes.
  std::atomic<std::int64_t> commit_send_ns{0};
  std::atomic<std::uint64_t> commit_sends{0};
  // Sessions with a queued commit whose writer was woken and has not run yet.
  std::atomic<std::uint64_t> commits_due{0};

  void count_commit_send(std::int64_t ns) {
    commit_send_ns.fetch_add(ns, std::memory_order_relaxed);
    commit_sends.fetch_add(1, std::memory_order_relaxed);
  }
};

/// Why a session ended: the first reason that either side had.
struct EndCause {
  GoodbyeReason reason = GoodbyeReason::closing;
  std::string text;
};

/// Returns true if a client whose session ended for this reason has broken a rule of the protocol.
constexpr bool is_broken_rule(GoodbyeReason reason) {
  return reason == GoodbyeReason::malformed_frame || reason == GoodbyeReason::malformed_message ||
         reason == GoodbyeReason::unexpected_message ||
         reason == GoodbyeReason::not_authenticated || reason == GoodbyeReason::flooding;
}

class SendRound;

class NetSession : public std::enable_shared_from_this<NetSession> {
 public:
  /// `budget` (of the server), `limits`, `events` and `counters` must outlive the session, and the
  /// threads of `decoders` those of `io`. `chunk_edge`: of the world. `address_reads`: the budget
  /// of reading that the sessions of an address share. `peer`: what is at the other end. A server
  /// is trusted from the start.
  NetSession(SessionId id, asio::io_context& io, asio::any_io_executor decoders,
             std::unique_ptr<ByteStream> stream, const NetLimits& limits, std::uint16_t chunk_edge,
             ByteBudget& budget, std::shared_ptr<ByteBudget> address_reads, NetEvents& events,
             NetCounters& counters, Sender peer = Sender::client);

  SessionId id() const { return id_; }
  const std::string& peer() const { return peer_; }
  AddressBlock address() const { return address_; }
  /// Returns for how long the write under way has waited for the client, or 0 if there is none.
  /// Thread: any.
  TimeUs write_us(TimeUs now_us) const {
    const TimeUs began_us = write_began_us_.load();
    return began_us == 0 ? 0 : now_us - began_us;
  }
  /// Returns why close() was called first, or the default if it was not called. If the stream could
  /// not be opened, the text says why. Thread: any.
  EndCause end();

  /// Opens the stream, reports on_connected() and starts both loops. Call it once.
  void start();

  /// Queues a message. Returns false if its class is full. After close() the message is dropped,
  /// and the call returns true.
  bool send(const EncodedMessage& message);
  /// Queues a message as send() does, and wakes the writer as a part of `round`.
  bool send(const EncodedMessage& message, SendRound& round);
  /// Reserves a place for a chunk that answers the view of this number. Returns nullopt if the
  /// class is full.
  std::optional<ChunkPlace> reserve_chunk(const ChunkKey& key, std::uint32_t view);
  void fill_chunk(ChunkPlace place, const ChunkEntry& chunk);
  /// Drops queued chunks outside of the view of which nothing was sent.
  void forget_outside(const View& view);
  void set_encodings(SessionEncodings encodings) { encodings_.store(encodings); }
  SessionEncodings encodings() const { return encodings_.load(); }
  /// Sets the optional parts of the protocol that are in force. Call it once, before the first
  /// chunk.
  void set_features(std::uint64_t features);

  /// Drops queued chunks, sends goodbye behind the queued edits and control messages, and closes
  /// the connection, at the latest after the linger time. If the stream is not open yet, it is
  /// closed at once. Further calls do nothing.
  void close(GoodbyeReason reason, const std::string& text);
  /// Reports that the client has authenticated. What it sends while it is being closed is then read
  /// until the linger time ends, so that the goodbye is not lost. Thread: any.
  void authenticated() { is_authenticated_ = true; }
  /// Reports that the client has proved to be another server of the same world. From now on
  /// TrustedLimits hold, it may send messages and bytes at any rate, and what follows its goodbye
  /// is read too. Thread: any.
  void trust();
  /// Reports that a message of NetEvents::on_message() was handled.
  void handled(std::size_t message_bytes);
  /// Counts further bytes as read, for a message that cost more than its size says. Reading pauses
  /// accordingly.
  void charge_reading(std::size_t bytes) { charged_.fetch_add(bytes); }
  /// Calls close() with `server_full` and closes the socket without waiting for the linger time.
  /// Nothing can be queued afterwards. The goodbye reaches the client only if the writer sends it
  /// before the socket is closed.
  void abort();

 private:
  using Strand = asio::strand<asio::io_context::executor_type>;
  static asio::awaitable<void> run(std::shared_ptr<NetSession> self);
  static asio::awaitable<void> read_loop(std::shared_ptr<NetSession> self);
  static asio::awaitable<void> write_loop(std::shared_ptr<NetSession> self);
  static asio::awaitable<void> end_after_linger(std::shared_ptr<NetSession> self);
  /// Ends both loops. Call it on the strand.
  void close_stream();
  /// Decodes what was read, and reports the messages.
  static asio::awaitable<Result<void>> feed(std::shared_ptr<NetSession> self, ByteView read);
  /// Decodes a message and appends it to decoded_. Thread: the strand or, while the read loop waits
  /// for it, a decoder.
  Result<void> decode(MessageKind kind, ByteView body);
  /// Handles the messages of decoded_. Fails with the error of one, or otherwise with that of
  /// `fed`.
  Result<void> handle_decoded(const Result<void>& fed);
  Result<void> on_receive_ack(const ReceiveAck& ack);
  void refuse(const Error& error);
  /// Returns true if input is to be dropped and only a little of it read: the session is being
  /// closed because the peer broke a rule or did not authenticate, or a client has said goodbye.
  bool drops_input();
  asio::awaitable<void> wait_for_read_budget(std::size_t bytes_read);
  /// Waits until close_stream() was called.
  static asio::awaitable<void> wait_for_close(std::shared_ptr<NetSession> self);
  bool must_pause() const {
    const std::size_t most =
        is_trusted_ ? TrustedLimits::kUnhandledBytes : limits_.unhandled_bytes_max;
    return unhandled_.load() >= most;
  }
  /// Wakes a paused reader if it need not pause any more.
  void wake_reader();
  bool has_chunk();
  /// Queues a message. Returns false if its class is full. `wakes`: see take_wake().
  bool queue(const EncodedMessage& message, bool& wakes);
  void wake_writer();
  /// Returns true if the caller must call post_wake() because the writer is idle. Requires the
  /// mutex.
  bool take_wake();
  void post_wake();
  /// Writes what is queued as far as the socket takes it at once. The write loop does the rest: what
  /// does not fit, terrain, and the end of the session. Nearly all commits are written here, without
  /// a coroutine or a timer. Returns true if commits were among it. Call it on the strand after
  /// take_wake().
  bool write_at_once();
  /// Starts to load the session's memory into the cache, for write_at_once().
  void prefetch() const;
  /// Does so for the stream's memory. Call it when that of the session is in the cache.
  void prefetch_stream() const;
  /// Makes the write loop go on. Call it on the strand.
  void resume_writer();
  void count_write(const SendQueue::Batch& batch, std::size_t bytes);
  void loop_ended();
  friend class SendRound;

  const SessionId id_;
  const Sender sender_;  // the peer
  const NetLimits& limits_;
  const std::uint16_t chunk_edge_;
  NetEvents& events_;
  NetCounters& counters_;
  Strand strand_;
  const asio::any_io_executor decoders_;
  std::unique_ptr<ByteStream> stream_;
  std::string peer_;
  const AddressBlock address_;
  std::atomic<SessionEncodings> encodings_{SessionEncodings{}};
  std::atomic<std::size_t> unhandled_{0};  // bytes, see NetLimits
  std::atomic<std::size_t> charged_{0};    // bytes to be added to the next read
  std::atomic<bool> reader_paused_{false};
  std::atomic<bool> is_authenticated_{false};
  std::atomic<bool> is_trusted_{false};
  std::atomic<TimeUs> write_began_us_{0};  // 0: no write is under way

  std::mutex mutex_;  // a leaf: guards the next seven
  SendQueue queue_;
  ChunkGate gate_;
  bool is_open_ = false;  // on_connected() was reported
  bool closing_ = false;
  EndCause end_;  // valid when closing
  bool writer_idle_ = false;
  bool is_woken_ = false;  // the writer was woken and has not run yet
  bool is_due_ = false;    // the session is counted in commits_due

  // On the strand from here on. A decoder uses reader_, messages_, decoded_ and broken_rule_ while
  // the read loop waits for it.
  asio::steady_timer write_wake_, read_wake_, read_turn_, linger_;
  bool is_writer_waiting_ =
      false;  // the write loop waits for write_wake_, and nothing was written since
  bool has_write_failed_ = false;  // in write_at_once()
  SendQueue::Batch unfinished_;    // what write_at_once() could not write; no pieces: nothing
  ByteBudget read_budget_;
  const std::shared_ptr<ByteBudget> address_reads_;
  FrameReader reader_;
  TokenBucket messages_;
  struct Decoded {
    Message message;
    std::size_t bytes;
  };
  std::vector<Decoded> decoded_;                                // not handled yet
  GoodbyeReason broken_rule_ = GoodbyeReason::malformed_frame;  // of the error that feed() returns
  int loops_ = 0;
  bool linger_started_ = false;
  bool has_said_goodbye_ = false;  // the peer
  bool reads_no_more_ = false;     // the stream was closed; on the strand
};

}  // namespace runstone
