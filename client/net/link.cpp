#include "client/net/link.hpp"

#include <sodium.h>

#include <algorithm>
#include <asio.hpp>
#include <asio/experimental/as_tuple.hpp>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "client/net/link_socket.hpp"
#include "common/os/host_port.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr auto kTuple = asio::experimental::as_tuple(asio::use_awaitable);
constexpr std::size_t kReadBytes = 64 * 1024;
/// Bytes that are decoded between two calls of is_full(). A chunk of a few dozen bytes can decode
/// to 12 MiB, so only a few of them may be decoded at once.
constexpr std::size_t kDecodeBytes = 256;
constexpr std::size_t kWriteBytes = 64 * 1024;
using std::chrono::milliseconds;

}  // namespace

struct Link::State {
  State(asio::io_context& context, LinkConfig link_config, LinkCallbacks& link_callbacks)
      : io(context), config(std::move(link_config)), callbacks(link_callbacks) {}

  // These functions act on the current connection.
  void send_receive_ack();
  void enqueue(ConnectionNumber to, const EncodedMessage& message);
  void close_socket();

  asio::io_context& io;
  const LinkConfig config;
  LinkCallbacks& callbacks;
  LinkStats stats;

  asio::ip::tcp::resolver resolver{io};
  LinkSocket socket{io};
  asio::steady_timer pause{io};  // between attempts; for the connect timeout; while events are full
  asio::steady_timer work_to_send{io};  // never expires; cancelled when there is something to send
  bool stopping = false;

  ConnectionNumber connection = 0;  // the newest one
  bool up = false;
  bool closing = false;  // close once all queued messages are sent
  std::string why_closed;
  std::unique_ptr<MessageStream> stream;  // of the newest connection; null before the first
  asio::steady_timer ack_timer{io};
  bool is_ack_timer_set = false;
};

// Acknowledges the chunk bytes read, now or when the acknowledgement is due.
void Link::State::send_receive_ack() {
  if (!up) return;
  const TimeUs now_us = steady_now_us();
  const auto due_us = stream->acknowledge(now_us);
  if (stream->has_output()) work_to_send.cancel();
  if (!due_us || is_ack_timer_set) return;
  is_ack_timer_set = true;
  ack_timer.expires_after(std::chrono::microseconds(std::max<TimeUs>(*due_us - now_us, 0)));
  ack_timer.async_wait([this](const std::error_code& /*cancelled*/) {
    is_ack_timer_set = false;
    send_receive_ack();
  });
}

void Link::State::enqueue(ConnectionNumber to, const EncodedMessage& message) {
  if (!up || to != connection) return;
  if (!stream->queue(message)) {
    why_closed = "send queue full";
    close_socket();
    return;
  }
  work_to_send.cancel();
}

void Link::State::close_socket() {
  socket.close();
  work_to_send.cancel();
}

// The coroutines are named functions over the state. Results are tuples, and no expression with a
// co_await has temporaries with destructors, because g++ 11 and 12 can destroy those twice.
namespace {

template <class State>
asio::awaitable<void> read_messages(State& state) {
  std::vector<std::uint8_t> buffer(kReadBytes);
  while (true) {
    const auto [error, count] = co_await state.socket.read_some(asio::buffer(buffer));
    if (error) {
      const std::string& words = state.socket.closing_words();
      if (state.why_closed.empty()) state.why_closed = words.empty() ? error.message() : words;
      break;
    }
    state.stats.bytes_received.fetch_add(count, std::memory_order_relaxed);
    const TimeUs received_us = steady_now_us();
    Result<void> fed;
    for (std::size_t at = 0; at < count && fed && !state.stopping; at += kDecodeBytes) {
      const std::size_t bytes = std::min(kDecodeBytes, count - at);
      fed = state.stream->receive(ByteView(buffer.data() + at, bytes), received_us);
      while (!state.stopping && state.callbacks.is_full()) {
        state.pause.expires_after(milliseconds(1));
        co_await state.pause.async_wait(kTuple);
      }
    }
    if (!fed) {
      state.why_closed = std::string("bad bytes from the server: ") + fed.error().what;
      break;
    }
    state.send_receive_ack();
  }
  state.up = false;
  state.close_socket();
  state.ack_timer.cancel();
  if (state.stopping) state.pause.cancel();  // ends the wait of stop()
}

template <class State>
asio::awaitable<void> write_messages(State& state, ConnectionNumber mine) {
  Bytes out;
  while (state.up && state.connection == mine) {
    out.clear();
    state.stream->write(out, kWriteBytes);
    if (out.empty()) {
      if (state.closing) {
        if (state.why_closed.empty()) state.why_closed = "closed by this client";
        state.close_socket();
        break;
      }
      state.work_to_send.expires_at(asio::steady_timer::time_point::max());
      co_await state.work_to_send.async_wait(kTuple);
      continue;
    }
    const ByteView bytes(out);
    const std::error_code error = co_await state.socket.write(bytes);
    if (error) break;  // the reader gets the same error and records the reason
    state.stats.bytes_sent.fetch_add(out.size(), std::memory_order_relaxed);
  }
}

/// Connects, performs the TLS handshake if the link is encrypted, and opens the WebSocket if it has
/// one. Returns as connect().
template <class State>
asio::awaitable<std::string> open(State& state,
                                  const asio::ip::tcp::resolver::results_type& endpoints) {
  const auto [error, endpoint] =
      co_await asio::async_connect(state.socket.tcp(), endpoints, kTuple);
  if (error) co_return "cannot connect: " + error.message();
  state.socket.set_no_delay();
  const LinkConfig& config = state.config;
  std::string failure;
  if (config.tls) failure = co_await state.socket.secure(*config.tls, config.host);
  if (!failure.empty() || config.web_path.empty()) co_return failure;
  const std::string host = to_string(HostPort{config.host, config.port});
  failure = co_await state.socket.open_websocket(host, config.web_path);
  co_return failure;
}

/// Resolves the host and connects. Returns an empty text if the socket is open, otherwise the
/// reason.
template <class State>
asio::awaitable<std::string> connect(State& state) {
  const std::string port = std::to_string(state.config.port);
  const auto [resolve_error, endpoints] =
      co_await state.resolver.async_resolve(state.config.host, port, kTuple);
  if (resolve_error)
    co_return "cannot resolve " + state.config.host + ": " + resolve_error.message();
  state.socket.reset();
  state.pause.expires_after(milliseconds(state.config.connect_ms_max));
  State* const raw = &state;
  state.pause.async_wait([raw](const std::error_code& cancelled) {
    if (!cancelled) raw->close_socket();
  });
  std::string failure = co_await open(state, endpoints);
  state.pause.cancel();
  co_return failure;
}

template <class State>
asio::awaitable<void> keep_connected(State& state) {
  std::int64_t pause_ms = state.config.pause_ms_first;
  while (!state.stopping) {
    std::string failure = co_await connect(state);
    if (state.stopping) break;
    if (failure.empty()) {
      ++state.connection;
      state.stats.connections.fetch_add(1, std::memory_order_relaxed);
      state.up = true;
      state.closing = false;
      state.why_closed.clear();
      state.stream = std::make_unique<MessageStream>(state.connection, state.stats, state.callbacks,
                                                     steady_now_ns);
      pause_ms = state.config.pause_ms_first;
      state.callbacks.on_connected(state.connection, state.socket.binding());
      asio::co_spawn(state.io, write_messages(state, state.connection), asio::detached);
      co_await read_messages(state);
      state.callbacks.on_disconnected(state.connection, state.why_closed);
    } else {
      state.callbacks.on_disconnected(0, std::move(failure));
    }
    if (state.stopping) break;
    const auto spread = static_cast<std::int64_t>(
        randombytes_uniform(static_cast<std::uint32_t>(pause_ms / 2 + 1)));
    state.pause.expires_after(milliseconds(pause_ms * 3 / 4 + spread));
    co_await state.pause.async_wait(kTuple);
    pause_ms = std::min(pause_ms * 2, state.config.pause_ms_max);
  }
}

}  // namespace

Link::Link(asio::io_context& io, LinkConfig config, LinkCallbacks& callbacks)
    : state_(std::make_unique<State>(io, std::move(config), callbacks)) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot start");
}

Link::~Link() = default;

void Link::start() { asio::co_spawn(state_->io, keep_connected(*state_), asio::detached); }

void Link::send(ConnectionNumber connection, const EncodedMessage& message) {
  state_->enqueue(connection, message);
}

void Link::close(ConnectionNumber connection) {
  if (connection != state_->connection) return;
  state_->closing = true;
  state_->work_to_send.cancel();
}

void Link::stop(std::int64_t wait_ms) {
  State& state = *state_;
  state.stopping = true;
  state.closing = true;
  state.resolver.cancel();
  state.pause.cancel();
  state.work_to_send.cancel();
  if (!state.up) return state.close_socket();
  // The pause timer is unused once `stopping` is set. Here it bounds the wait for queued messages.
  state.pause.expires_after(milliseconds(wait_ms));
  state.pause.async_wait([raw = &state](const std::error_code& cancelled) {
    if (!cancelled && raw->up) raw->close_socket();
  });
}

const LinkStats& Link::stats() const { return state_->stats; }

}  // namespace runstone
