#include "server/net/net_session.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <asio/bind_executor.hpp>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/post.hpp>
#include <asio/use_awaitable.hpp>
#include <chrono>
#include <utility>

#include "common/os/steady_clock.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/net/await_tuple.hpp"
#include "server/net/net_log.hpp"
#include "server/net/send_round.hpp"

namespace runstone {
namespace {

// The messages of all sessions wait for the world strand in one queue, so no session may have many
// there: a read is short, and unhandled_bytes_max limits the bytes. Bytes are counted, not
// messages, because the cost of a message grows with its bytes.
constexpr std::size_t kReadBytes = 4 * 1024;
// Counted for each message that waits, in addition to its bytes.
constexpr std::size_t kMessageBytes = 64;
// Counted as read for each message of the world strand, in addition to its bytes: decoding a byte
// of a large paste takes 13 ns, and a message takes at least 7 us.
constexpr std::size_t kMessageReadBytes = 512;
// Counted as read for a ReceiveAck, which the world strand never sees, in addition to its bytes. On
// a fast link a regular client sends a thousand of them a second (kReceiveAckUsMin).
constexpr std::size_t kAckReadBytes = 256;
// A client that has broken a rule, has said goodbye or was refused before it authenticated is being
// closed. At most so many of its further bytes are read and dropped, because decrypting the rest of
// a flood would cost more than the flood did. The connection stays open for the linger time, so
// that the client can read the goodbye.
constexpr std::size_t kDroppedBytesMax = 64 * 1024;
// Room for a chunk fragment that must be sent although the socket has none.
constexpr std::size_t kStarvedRoomBytes = 2 * 1024;
// Messages of more bytes are decoded on the decoders. The largest paste takes half a millisecond.
constexpr std::size_t kSmallBytes = 2 * kReadBytes;
constexpr TimeUs kRoomPauseUsMax = 50'000;
// Part of the read budget that may be used at once, for the list of cached chunks or a large paste.
constexpr TimeUs kReadBurstUs = 2'000'000;

asio::steady_timer::time_point time_point_of(TimeUs us) {
  return asio::steady_timer::time_point(std::chrono::microseconds(us));
}

SendLimits trusted(SendLimits limits) {
  limits.edit_bytes = TrustedLimits::kEditBytes;
  limits.edit_count = TrustedLimits::kEditCount;
  limits.control_count = TrustedLimits::kControlCount;
  return limits;
}

/// Starts to load memory into the cache that is written soon, and does not wait for it.
void prefetch_lines(const void* begin, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < bytes; at += kLine)
    __builtin_prefetch(static_cast<const char*>(begin) + at, 1);
}

void buffers_of(const SendQueue::Batch& batch, std::vector<asio::const_buffer>& buffers) {
  buffers.clear();
  for (const auto& piece : batch.pieces) {
    buffers.push_back(asio::buffer(piece.header));
    buffers.push_back(asio::buffer(piece.body.data(), piece.body.size()));
  }
}

}  // namespace

NetSession::NetSession(SessionId id, asio::io_context& io, asio::any_io_executor decoders,
                       std::unique_ptr<ByteStream> stream, const NetLimits& limits,
                       std::uint16_t chunk_edge, ByteBudget& budget,
                       std::shared_ptr<ByteBudget> address_reads, NetEvents& events,
                       NetCounters& counters, Sender peer)
    : id_(id),
      sender_(peer),
      limits_(limits),
      chunk_edge_(chunk_edge),
      events_(events),
      counters_(counters),
      strand_(asio::make_strand(io)),
      decoders_(std::move(decoders)),
      stream_(std::move(stream)),
      peer_(stream_->peer()),
      address_(stream_->address()),
      queue_(limits.send),
      gate_(limits.bytes_per_second, budget),
      write_wake_(strand_),
      read_wake_(strand_),
      read_turn_(strand_),
      linger_(strand_),
      read_budget_(limits.read_bytes_per_second),
      address_reads_(std::move(address_reads)),
      reader_(peer),
      messages_(limits.messages_per_second, limits.message_burst) {
  // The timer never expires. Cancelling it wakes the loop that waits on it.
  read_wake_.expires_at(asio::steady_timer::time_point::max());
  if (peer == Sender::server) trust();
}

void NetSession::start() { asio::co_spawn(strand_, run(shared_from_this()), asio::detached); }

asio::awaitable<void> NetSession::run(std::shared_ptr<NetSession> self) {
  // The timer has no other use before the loops run.
  self->linger_.expires_after(std::chrono::milliseconds(self->limits_.handshake_ms));
  self->linger_.async_wait([raw = self.get(), self](const asio::error_code& cancelled) {
    if (!cancelled) raw->stream_->close();
  });
  const StreamStart started = co_await self->stream_->open();
  self->linger_.cancel();
  bool is_wanted = started == StreamStart::open;
  if (is_wanted) {
    const std::lock_guard lock(self->mutex_);
    is_wanted = !self->closing_;
    self->is_open_ = is_wanted;
  } else {
    const std::string why =
        started == StreamStart::not_encrypted ? "no TLS" : self->stream_->failure();
    // Whoever made an outgoing connection gets the reason and logs it.
    if (self->sender_ == Sender::client) log_failed_handshake(self->id_, self->peer_, why);
    self->close(GoodbyeReason::closing, why);
  }
  if (!is_wanted) {
    self->stream_->close();
    self->events_.on_refused(self->id_);
    co_return;
  }
  self->events_.on_connected(self->id_, self->stream_->binding());
  self->loops_ = 2;
  asio::co_spawn(self->strand_, read_loop(self), asio::detached);
  asio::co_spawn(self->strand_, write_loop(self), asio::detached);
}

bool NetSession::queue(const EncodedMessage& message, bool& wakes) {
  const std::lock_guard lock(mutex_);
  if (closing_) return true;
  if (!queue_.push(message)) return false;
  wakes = take_wake();
  // The cost of sending this message is not in commit_send_ns before the writer has run.
  if (message.kind == kKindOf<Commit> && is_woken_ && !std::exchange(is_due_, true)) {
    counters_.commits_due.fetch_add(1, std::memory_order_relaxed);
  }
  return true;
}

bool NetSession::send(const EncodedMessage& message) {
  bool wakes = false;
  const bool is_queued = queue(message, wakes);
  if (wakes) post_wake();
  return is_queued;
}

bool NetSession::send(const EncodedMessage& message, SendRound& round) {
  bool wakes = false;
  const bool is_queued = queue(message, wakes);
  if (wakes) round.add(shared_from_this());
  return is_queued;
}

std::optional<ChunkPlace> NetSession::reserve_chunk(const ChunkKey& key, std::uint32_t view) {
  const std::lock_guard lock(mutex_);
  if (closing_) return ChunkPlace{0};  // no place: filling it does nothing
  return queue_.reserve_chunk(key, view);
}

void NetSession::forget_outside(const View& view) {
  {
    const std::lock_guard lock(mutex_);
    queue_.forget_outside(view);
  }
  wake_writer();  // there may be room again, or a filled chunk may be first now
}

void NetSession::fill_chunk(ChunkPlace place, const ChunkEntry& chunk) {
  {
    const std::lock_guard lock(mutex_);
    if (closing_) return;
    queue_.fill(place, chunk);
  }
  wake_writer();
}

void NetSession::set_features(std::uint64_t features) {
  if ((features & kFeatureReceiveAck) == 0) return;
  const std::lock_guard lock(mutex_);
  gate_.pace();
}

void NetSession::close(GoodbyeReason reason, const std::string& text) {
  bool is_open = false;
  {
    const std::lock_guard lock(mutex_);
    if (closing_) return;
    closing_ = true;
    is_open = is_open_;
    end_ = {reason, text};
    queue_.drop_chunks();
    // If the goodbye does not fit, the client has not read for long. It gets only the end of the
    // stream.
    (void)queue_.push(encode_message(Goodbye{reason, text}));
  }
  if (!is_open) {
    asio::post(strand_, [self = shared_from_this()] { self->stream_->close(); });
    return;
  }
  const auto begin = [self = shared_from_this()] {
    if (std::exchange(self->linger_started_, true)) return;
    asio::co_spawn(self->strand_, end_after_linger(self), asio::detached);
  };
  asio::post(strand_, begin);
  wake_writer();
}

EndCause NetSession::end() {
  const std::lock_guard lock(mutex_);
  return end_;
}

void NetSession::trust() {
  {
    const std::lock_guard lock(mutex_);
    queue_.set_limits(trusted(limits_.send));
  }
  is_trusted_ = true;
  wake_reader();
}

bool NetSession::drops_input() {
  // A goodbye may overtake edits, and those of a server must not be lost.
  if (has_said_goodbye_ && !is_trusted_) return true;
  const std::lock_guard lock(mutex_);
  return closing_ && (!is_authenticated_ || is_broken_rule(end_.reason));
}

void NetSession::handled(std::size_t message_bytes) {
  unhandled_.fetch_sub(message_bytes + kMessageBytes);
  wake_reader();
}

void NetSession::wake_reader() {
  if (!reader_paused_.load() || must_pause()) return;
  const auto wake = [self = shared_from_this()] { self->read_wake_.cancel(); };
  asio::post(strand_, wake);
}

void NetSession::abort() {
  // After this call nothing is queued any more.
  close(GoodbyeReason::server_full, "no room for one more handshake");
  const auto end = [self = shared_from_this()] { self->close_stream(); };
  asio::post(strand_, end);
}

bool NetSession::has_chunk() {
  const std::lock_guard lock(mutex_);
  return queue_.has_chunk();
}

void NetSession::wake_writer() {
  {
    const std::lock_guard lock(mutex_);
    if (!take_wake()) return;
  }
  post_wake();
}

bool NetSession::take_wake() {
  if (!std::exchange(writer_idle_, false)) return false;
  return is_woken_ = true;
}

void NetSession::post_wake() {
  const auto wake = [self = shared_from_this()] {
    const std::int64_t began_ns = thread_cpu_ns();
    if (self->write_at_once()) self->counters_.count_commit_send(thread_cpu_ns() - began_ns);
  };
  asio::post(strand_, wake);
}

void NetSession::resume_writer() {
  is_writer_waiting_ = false;
  write_wake_.cancel();
}

void NetSession::count_write(const SendQueue::Batch& batch, std::size_t bytes) {
  counters_.bytes_out.fetch_add(bytes, std::memory_order_relaxed);
  if (batch.chunk_bytes != 0)
    counters_.chunk_bytes_out.fetch_add(batch.chunk_bytes, std::memory_order_relaxed);
  counters_.edit_bytes_out.fetch_add(batch.edit_bytes, std::memory_order_relaxed);
}

void NetSession::prefetch() const { prefetch_lines(this, sizeof *this); }

void NetSession::prefetch_stream() const {
  constexpr std::size_t kStreamBytes = 512;
  prefetch_lines(stream_.get(), kStreamBytes);
}

bool NetSession::write_at_once() {
  // The writer runs already, and takes what is queued.
  if (!is_writer_waiting_) return false;
  // The sessions of a thread share them: they stay in its cache.
  thread_local SendQueue::Batch batch;
  thread_local std::vector<asio::const_buffer> buffers;
  const TimeUs now_us = steady_now_us();
  bool is_drained = false, is_all = true;
  {
    const std::lock_guard lock(mutex_);
    is_woken_ = false;
    if (std::exchange(is_due_, false))
      counters_.commits_due.fetch_sub(1, std::memory_order_relaxed);
    if (closing_ || queue_.has_chunk()) {
      resume_writer();
      return false;
    }
    if (queue_.take(batch, 0)) gate_.sent(0, batch.bytes, now_us);
    gate_.mark_app_limited();
    is_drained = queue_.take_drained();
    is_all = !queue_.can_take();
    writer_idle_ = is_all;
  }
  if (is_drained) events_.on_drained(id_);
  bool has_commits = false;
  if (!batch.pieces.empty()) {
    buffers_of(batch, buffers);
    write_began_us_.store(now_us, std::memory_order_relaxed);
    const IoResult wrote = stream_->write_now(buffers, 0);
    has_commits = batch.has_commits;
    has_write_failed_ = static_cast<bool>(wrote.error);
    is_all = is_all && !wrote.has_rest && !wrote.error;
    if (!wrote.error) count_write(batch, wrote.bytes);
    if (wrote.has_rest) {
      unfinished_ = std::exchange(batch, {});
    } else {
      batch.messages.clear();
      write_began_us_.store(0, std::memory_order_relaxed);
    }
  }
  if (!is_all) resume_writer();
  return has_commits;
}

asio::awaitable<void> NetSession::end_after_linger(std::shared_ptr<NetSession> self) {
  self->linger_.expires_after(std::chrono::milliseconds(self->limits_.linger_ms));
  self->read_wake_.cancel();  // a paused reader continues until the end of the stream
  const auto [error] = co_await self->linger_.async_wait(kTuple);
  (void)error;  // cancelled when both loops have ended; closing twice is harmless
  self->close_stream();
}

void NetSession::close_stream() {
  reads_no_more_ = true;
  stream_->close();
  read_turn_.cancel();
}

// Handling a message costs more than sending it. So each session is read no faster than a regular
// client sends, and TCP makes the others wait.
asio::awaitable<void> NetSession::wait_for_read_budget(std::size_t bytes_read) {
  if (is_trusted_) co_return;
  const TimeUs now_us = steady_now_us();
  const std::size_t bytes = bytes_read + charged_.exchange(0);
  const TimeUs slot_us =
      std::max(read_budget_.book(bytes, now_us), address_reads_->book(bytes, now_us)) -
      kReadBurstUs;
  if (slot_us <= now_us || reads_no_more_) co_return;
  read_turn_.expires_at(time_point_of(slot_us));
  const auto [error] = co_await read_turn_.async_wait(kTuple);
  (void)error;  // cancelled when the stream is closed; the next read fails then
}

asio::awaitable<void> NetSession::wait_for_close(std::shared_ptr<NetSession> self) {
  if (self->reads_no_more_) co_return;
  self->read_turn_.expires_at(asio::steady_timer::time_point::max());
  const auto [error] = co_await self->read_turn_.async_wait(kTuple);
  (void)error;  // cancelled by close_stream()
}

asio::awaitable<Result<void>> NetSession::feed(std::shared_ptr<NetSession> self, ByteView read) {
  const FrameReader::OnMessage on_message = [raw = self.get()](MessageKind kind, ByteView body) {
    return raw->decode(kind, body);
  };
  const bool is_large = self->reader_.completed_bytes_max(read.size()) > kSmallBytes;
  if (is_large) co_await asio::post(asio::bind_executor(self->decoders_, asio::use_awaitable));
  const Result<void> fed = self->reader_.feed(read, on_message);
  if (is_large) co_await asio::post(asio::bind_executor(self->strand_, asio::use_awaitable));
  co_return self->handle_decoded(fed);
}

Result<void> NetSession::decode(MessageKind kind, ByteView body) {
  counters_.messages_in.fetch_add(1, std::memory_order_relaxed);
  if (!is_trusted_ && !messages_.take(1, steady_now_us())) {
    broken_rule_ = GoodbyeReason::flooding;
    return fail(ErrorCode::limit_exceeded, "more messages than the rate allows");
  }
  auto message = decode_message(sender_, kind, body, chunk_edge_);
  if (!message) {
    broken_rule_ = GoodbyeReason::malformed_message;
    return failure(message.error());
  }
  decoded_.push_back({*std::move(message), body.size()});
  return {};
}

Result<void> NetSession::handle_decoded(const Result<void>& fed) {
  Result<void> result = fed;
  for (Decoded& decoded : decoded_) {
    if (const auto* ack = std::get_if<ReceiveAck>(&decoded.message)) {
      charge_reading(kAckReadBytes);
      if (const auto taken = on_receive_ack(*ack); !taken) {
        result = taken;
        break;
      }
      continue;
    }
    has_said_goodbye_ = has_said_goodbye_ || std::holds_alternative<Goodbye>(decoded.message);
    charge_reading(kMessageReadBytes);
    unhandled_.fetch_add(decoded.bytes + kMessageBytes);
    events_.on_message(id_, std::move(decoded.message), decoded.bytes);
  }
  decoded_.clear();
  return result;
}

Result<void> NetSession::on_receive_ack(const ReceiveAck& ack) {
  {
    const std::lock_guard lock(mutex_);
    if (!gate_.is_paced()) {
      broken_rule_ = GoodbyeReason::unexpected_message;
      return fail(ErrorCode::bad_value, "receive ack, but its feature is not in force");
    }
    const auto taken = gate_.acked(ack.chunk_bytes, steady_now_us());
    if (!taken) {
      broken_rule_ = GoodbyeReason::malformed_message;
      return taken;
    }
    queue_.set_chunk_backlog(gate_.backlog_bytes());
    if (!queue_.has_chunk()) return {};
  }
  wake_writer();
  return {};
}

void NetSession::refuse(const Error& error) {
  counters_.malformed.fetch_add(1, std::memory_order_relaxed);
  log_broken_rule(id_, peer_, broken_rule_, error);
  close(broken_rule_, std::string(error.what) + " (at byte " + std::to_string(error.offset) + ")");
}

asio::awaitable<void> NetSession::read_loop(std::shared_ptr<NetSession> self) {
  Bytes buffer(kReadBytes);
  bool refused = false;
  std::size_t dropped_bytes = 0;
  for (;;) {
    const asio::mutable_buffer into = asio::buffer(buffer);
    const IoResult got = co_await self->stream_->read_some(into);
    if (got.error) break;
    self->counters_.bytes_in.fetch_add(got.received, std::memory_order_relaxed);
    co_await self->wait_for_read_budget(got.received);
    // While closing, input is read and dropped. Unread input would make the kernel reset the
    // connection, and the goodbye would be lost.
    if (refused || self->drops_input()) {
      dropped_bytes += got.received;
      if (dropped_bytes <= kDroppedBytesMax) continue;
      co_await wait_for_close(self);
      break;
    }
    self->broken_rule_ = GoodbyeReason::malformed_frame;
    const ByteView read(buffer.data(), got.bytes);
    const Result<void> fed = co_await feed(self, read);
    if (!fed) {
      self->refuse(fed.error());
      refused = true;
    }
    while (self->must_pause() && !self->linger_started_) {
      self->reader_paused_.store(true);
      if (!self->must_pause()) break;  // handled() may have been called before the flag was set
      const auto [error] = co_await self->read_wake_.async_wait(kTuple);
      (void)error;  // always cancelled, which is the wake
    }
    self->reader_paused_.store(false);
  }
  // The peer has closed the connection, so nobody reads what is queued.
  self->close(GoodbyeReason::closing,
              self->has_said_goodbye_ ? "the client said goodbye" : "end of stream");
  self->loop_ended();
}

asio::awaitable<void> NetSession::write_loop(std::shared_ptr<NetSession> self) {
  SendQueue::Batch batch;
  std::vector<asio::const_buffer> buffers;
  TimeUs room_pause_us = 0;
  for (;;) {
    if (self->has_write_failed_) break;
    if (!self->unfinished_.pieces.empty()) {
      const IoResult rest = co_await self->stream_->write_rest();
      self->write_began_us_.store(0);
      self->unfinished_ = {};
      if (rest.error) break;
      self->counters_.bytes_out.fetch_add(rest.bytes, std::memory_order_relaxed);
    }
    bool has_batch = false;
    bool is_drained = false;
    bool is_last = false;
    auto wake = asio::steady_timer::time_point::max();
    // room() is a system call, so it is made without the mutex and only for terrain.
    const bool asks = self->has_chunk();
    const StreamRoom room = asks ? self->stream_->room() : StreamRoom{};
    const bool has_room = room.bytes > kFrameHeaderBytes;
    // The pause grows while the client does not read. A client that reads wakes the writer by its
    // acknowledgements.
    room_pause_us = has_room ? 0 : std::clamp(2 * room_pause_us, room.again_us, kRoomPauseUsMax);
    {
      const std::lock_guard lock(self->mutex_);
      self->writer_idle_ = self->is_woken_ = false;
      if (std::exchange(self->is_due_, false)) {
        self->counters_.commits_due.fetch_sub(1, std::memory_order_relaxed);
      }
      const TimeUs now_us = steady_now_us();
      const bool has_chunk = self->queue_.has_chunk();
      if (has_chunk && !asks) continue;  // a chunk was queued since has_chunk()
      // Edits alone may fill the window for long. A starved class sends in any case.
      const std::size_t room_bytes =
          !has_room && self->queue_.are_chunks_starved() ? kStarvedRoomBytes : room.bytes;
      const std::size_t chunk_body_max = has_chunk ? self->gate_.open(now_us, room_bytes) : 0;
      has_batch = self->queue_.take(batch, chunk_body_max);
      if (has_batch) self->gate_.sent(batch.chunk_bytes, batch.bytes - batch.chunk_bytes, now_us);
      if (!has_chunk) self->gate_.mark_app_limited();
      if (has_chunk && chunk_body_max == 0) {
        wake = time_point_of(std::max(now_us + room_pause_us, self->gate_.next_us(now_us)));
      }
      is_drained = self->queue_.take_drained();
      is_last = !has_batch && self->closing_;
      if (!has_batch && !is_last) self->writer_idle_ = true;
    }
    if (is_drained) self->events_.on_drained(self->id_);
    if (is_last) break;
    if (!has_batch) {
      // A wake runs write_at_once(), which cancels this wait if the loop must go on. It is posted to
      // this strand, so it cannot run before the wait has begun. Terrain that must wait sets the
      // time.
      self->write_wake_.expires_at(wake);
      self->is_writer_waiting_ = true;
      const auto [error] = co_await self->write_wake_.async_wait(kTuple);
      (void)error;
      self->is_writer_waiting_ = false;
      continue;
    }
    const std::int64_t began_ns = thread_cpu_ns();
    self->write_began_us_.store(steady_now_us());
    buffers_of(batch, buffers);
    const IoResult wrote = self->stream_->write_now(buffers, batch.chunk_bytes);
    if (wrote.error) break;
    self->count_write(batch, wrote.bytes);
    if (batch.has_commits) self->counters_.count_commit_send(thread_cpu_ns() - began_ns);
    if (wrote.has_rest)
      self->unfinished_ = std::exchange(batch, {});
    else
      self->write_began_us_.store(0);
  }
  self->stream_->shutdown_send();
  // The linger timer ends a reader that still waits.
  self->close(GoodbyeReason::closing, "write failed");
  self->loop_ended();
}

void NetSession::loop_ended() {
  if (--loops_ > 0) return;
  linger_.cancel();
  stream_->close();
  events_.on_disconnected(id_);
}

}  // namespace runstone
