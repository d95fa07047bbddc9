#include "client/net/link.hpp"

#include <sodium.h>

#include <algorithm>
#include <asio.hpp>
#include <asio/experimental/as_tuple.hpp>
#include <chrono>
#include <stdexcept>
#include <utility>
#include <vector>

#include "client/net/link_socket.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr auto kTuple = asio::experimental::as_tuple(asio::use_awaitable);
constexpr std::size_t kReadBytes = 64 * 1024;
/// Bytes that are decoded between two calls of is_full(). A chunk of a few dozen bytes can decode
/// to 12 MiB, so only a few of them may be decoded at once.
constexpr std::size_t kDecodeBytes = 256;
constexpr std::size_t kWriteBytes = 64 * 1024;
using asio::ip::tcp;
using std::chrono::milliseconds;

std::vector<LinkTarget> given_targets(const LinkConfig& config) {
  std::vector<LinkTarget> out = {{{config.host, config.port}, config.web_path}};
  for (const HostPort& server : config.more) out.push_back({server, config.web_path});
  return out;
}

/// Returns the addresses that a name has, from this one on.
std::vector<tcp::endpoint> endpoints_from(std::uint32_t first,
                                          const tcp::resolver::results_type& found) {
  std::vector<tcp::endpoint> out;
  for (const auto& entry : found) out.push_back(entry.endpoint());
  if (!out.empty()) std::ranges::rotate(out, out.begin() + first % out.size());
  return out;
}

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

  ConnectOrder<LinkTarget> order{
      given_targets(config), {config.pause_ms_first, config.pause_ms_max}, randombytes_uniform};
  Attempt attempt;  // the newest one

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
asio::awaitable<std::string> open(State& state, const std::vector<tcp::endpoint>& endpoints) {
  const auto [error, endpoint] =
      co_await asio::async_connect(state.socket.tcp(), endpoints, kTuple);
  if (error) co_return "cannot connect: " + error.message();
  state.socket.set_no_delay();
  const LinkTarget& target = state.attempt.address;
  std::string failure;
  if (state.config.tls)
    failure = co_await state.socket.secure(*state.config.tls, target.server.host);
  if (!failure.empty() || target.web_path.empty()) co_return failure;
  const std::string host = to_string(target.server);
  failure = co_await state.socket.open_websocket(host, target.web_path);
  co_return failure;
}

/// Resolves the host and connects. Returns an empty text if the socket is open, otherwise the
/// reason.
template <class State>
asio::awaitable<std::string> connect(State& state) {
  const HostPort& server = state.attempt.address.server;
  const std::string port = std::to_string(server.port);
  const auto [resolve_error, found] =
      co_await state.resolver.async_resolve(server.host, port, kTuple);
  if (resolve_error) co_return "cannot resolve " + server.host + ": " + resolve_error.message();
  const std::vector<tcp::endpoint> endpoints = endpoints_from(randombytes_uniform(256), found);
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
  while (!state.stopping) {
    state.attempt = state.order.next();
    if (state.attempt.pause_ms > 0) {
      state.pause.expires_after(milliseconds(state.attempt.pause_ms));
      co_await state.pause.async_wait(kTuple);
      if (state.stopping) break;
    }
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
      state.order.connected();
      state.callbacks.on_connected(state.connection, state.socket.binding());
      asio::co_spawn(state.io, write_messages(state, state.connection), asio::detached);
      co_await read_messages(state);
      state.callbacks.on_disconnected(state.connection, state.why_closed);
    } else {
      state.callbacks.on_disconnected(0, std::move(failure));
    }
  }
}

}  // namespace

Link::Link(asio::io_context& io, LinkConfig config, LinkCallbacks& callbacks)
    : state_(std::make_unique<State>(io, std::move(config), callbacks)) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot start");
}

Link::~Link() = default;

void Link::start() { asio::co_spawn(state_->io, keep_connected(*state_), asio::detached); }

void Link::set_servers(const Servers& list) {
  const LinkConfig& config = state_->config;
  state_->order.set_others(config.web_path.empty() ? other_servers(list)
                                                   : other_gateways(list, config.tls.has_value()));
}

const Link::Attempt& Link::attempt() const { return state_->attempt; }

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
