// RawClient: a blocking socket that sends and receives frames and messages, over TLS unless told
// otherwise. It does only what the test does, and it can send any bytes, also invalid ones. Reads
// and writes have a deadline, so a test fails instead of hanging. Threads: after the handshake one
// may send while another reads.
#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/core/assert.hpp"
#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/password_key.hpp"
#include "tests/support/tls/ipv4_socket.hpp"
#include "tests/support/tls/tls_client.hpp"

namespace runstone::test {

class RawClient {
 public:
  enum class Encryption { tls, none };
  /// Connects to a server on this machine from the IPv4 address `from` (host order, of
  /// 127.0.0.0/8), and performs the TLS handshake.
  explicit RawClient(std::uint16_t port, std::uint32_t from = INADDR_LOOPBACK,
                     Encryption encryption = Encryption::tls,
                     const TlsContext& context = TlsContext::client(),
                     const std::string& host = "127.0.0.1")
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const sockaddr_in here = ipv4_endpoint(from, 0), there = ipv4_endpoint(INADDR_LOOPBACK, port);
    is_open_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0 &&
               ::connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0;
    const timeval deadline{kSendSeconds, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &deadline, sizeof deadline);
    if (!is_open_ || encryption != Encryption::tls) return;
    auto channel = connect_tls(socket_, source_, context, host);
    is_open_ = channel.has_value();
    if (channel) tls_.emplace(*std::move(channel));
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool is_open() const { return is_open_; }

  /// Identifies the connection if it is encrypted.
  std::optional<ChannelBinding> binding() const {
    return tls_ ? std::optional(tls_->binding()) : std::nullopt;
  }

  void send_bytes(ByteView bytes) {
    if (!tls_) return send_to_socket(bytes);
    if (!is_open_) return;
    Bytes records;
    {
      const std::lock_guard lock(tls_mutex_);
      if (!tls_->write(bytes)) return;
      records = std::exchange(tls_->output(), {});
    }
    send_to_socket(records);
  }
  /// Sends bytes past TLS.
  void send_to_socket(ByteView bytes) {
    if (!send_all(socket_, bytes)) is_open_ = false;
  }
  /// Sends a message. A view gets the number that follows the last one.
  void send(Message message) {
    if (auto* view = std::get_if<View>(&message)) view->number = ++views_;
    send(encode_message(message));
  }
  void send(const EncodedMessage& message) {
    Bytes bytes;
    frames_.append(message, bytes);
    send_bytes(bytes);
  }
  void shutdown_send() { ::shutdown(socket_, SHUT_WR); }

  /// Returns the next message, or nullopt at the end of the stream or at the deadline.
  std::optional<Message> next(int deadline_ms = 10'000) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(deadline_ms);
    while (arrived_.empty()) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          end - std::chrono::steady_clock::now());
      if (left.count() <= 0 || !read_some(static_cast<int>(left.count()))) return std::nullopt;
    }
    Message message = std::move(arrived_.front());
    arrived_.pop_front();
    return message;
  }
  /// Returns the next message of one kind, or the next ChunkSnapshot of any message. Earlier
  /// messages are passed to `seen`, if any, and dropped.
  template <class Kind>
  std::optional<Kind> next_of(std::vector<Message>* seen = nullptr) {
    while (auto message = next()) {
      if constexpr (std::is_same_v<Kind, ChunkSnapshot>) {
        if (auto* found = snapshot_in(*message)) return std::move(*found);
      } else {
        if (auto* found = std::get_if<Kind>(&*message)) return std::move(*found);
      }
      if (seen != nullptr) seen->push_back(std::move(*message));
    }
    return std::nullopt;
  }
  /// Reads until every edit up to `seq` is durable. Returns false if the server closes before.
  bool sees_durable(Sequence seq) {
    while (const auto durable = next_of<Durable>()) {
      if (durable->seq >= seq) return true;
    }
    return false;
  }
  /// Reads until the server closes. Returns its goodbye, or nullopt if there was none.
  std::optional<Goodbye> goodbye() {
    auto found = next_of<Goodbye>();
    while (found && next()) {
    }
    return found;
  }
  /// Returns true if the server has closed the connection.
  bool sees_the_end() {
    while (next()) {
    }
    return !is_open_;
  }

  /// Returns the snapshot of a Chunks message that was cut, or null.
  static ChunkSnapshot* snapshot_in(Message& message) {
    auto* chunks = std::get_if<Chunks>(&message);
    return chunks == nullptr ? nullptr : std::get_if<ChunkSnapshot>(&chunks->chunks.front());
  }

  Hello hello(std::uint8_t who, ClientInstance instance = 1) {
    seed_.fill(who);
    Hello h;
    h.key = key_pair_of(seed_).public_key;
    h.instance = instance;
    h.features = features;
    h.name = name.empty() ? "player" + std::to_string(who) : name;
    return h;
  }
  /// Does the whole handshake. Returns nullopt if the server closed.
  std::optional<SessionAccepted> join(std::uint8_t who, ClientInstance instance = 1) {
    return join_as_on(who, instance, binding());
  }
  /// The same with signatures over another connection, as of somebody who relays a handshake.
  std::optional<SessionAccepted> join_as_on(std::uint8_t who, ClientInstance instance,
                                            const std::optional<ChannelBinding>& signed_binding) {
    const Hello h = hello(who, instance);
    send(h);
    auto got = next_of<Welcome>();
    if (!got) return std::nullopt;
    welcome = *std::move(got);
    chunk_edge_ = welcome.chunk_edge;
    if (!verify(welcome.server_key, server_transcript(h, welcome, binding()), welcome.signature))
      return std::nullopt;
    ClientAuth auth{sign(key_pair_of(seed_), client_transcript(h, welcome, signed_binding)),
                    ticket};
    if (!password.empty() && welcome.password_salt) {
      const auto key = password_key(password, *welcome.password_salt);
      RUNSTONE_ASSERT(key.has_value());
      auth.password_key = *key;
    }
    send(auth);
    std::vector<Message> seen;
    auto accepted = next_of<SessionAccepted>(&seen);
    for (const Message& message : seen) {
      if (const auto* goodbye = std::get_if<Goodbye>(&message)) refusal = goodbye->text;
    }
    return accepted;
  }

  Welcome welcome;
  std::uint64_t features = 0;  // offered in hello
  bool cuts_chunks = true;     // tests get each chunk of a message as a snapshot of its own
  std::string name;            // of the player; empty: "player" and the number
  std::string ticket;          // an invite token; empty: none
  std::string password;        // sent to a world that has one; empty: none
  std::string refusal;         // text of the goodbye in place of SessionAccepted; empty: none
  std::function<void(MessageKind, ByteView)>
      on_body;  // called with each message before it is decoded

 private:
  static constexpr time_t kSendSeconds = 60;

  TlsChannel::Status read_text(Bytes& buffer, std::size_t& bytes) {
    const std::lock_guard lock(tls_mutex_);
    return tls_->read(buffer, bytes);
  }
  /// Reads what comes into the buffer. Returns the number of bytes, 0 at the end of the stream, or
  /// nullopt at the deadline.
  std::optional<std::size_t> receive(Bytes& buffer, int deadline_ms) {
    if (!tls_) {
      if (!wait_input(socket_, deadline_ms)) return std::nullopt;
      const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), 0);
      return got > 0 ? static_cast<std::size_t>(got) : 0;
    }
    for (;;) {
      std::size_t bytes = 0;
      const TlsChannel::Status status = read_text(buffer, bytes);
      if (status == TlsChannel::Status::done) return bytes;
      const bool is_over = source_.is_at_end() || source_.error();
      if (status != TlsChannel::Status::wants_input || is_over) return 0;
      if (!wait_input(socket_, deadline_ms)) return std::nullopt;
    }
  }

  bool read_some(int deadline_ms) {
    if (!is_open_) return false;
    Bytes buffer(65'536);
    const auto got = receive(buffer, deadline_ms);
    if (!got) return false;
    if (*got == 0) {
      is_open_ = false;
      return false;
    }
    const auto on_message = [this](MessageKind kind, ByteView body) -> Result<void> {
      if (on_body) on_body(kind, body);
      auto message = decode_message(Sender::server, kind, body, chunk_edge_);
      if (!message) return failure(message.error());
      // The chunk edge is known from welcome on, also for messages of the same read.
      if (const auto* w = std::get_if<Welcome>(&*message)) chunk_edge_ = w->chunk_edge;
      const auto* uniform = cuts_chunks ? std::get_if<UniformChunks>(&*message) : nullptr;
      if (uniform != nullptr) {
        for (const UniformChunk& each : uniform->chunks) {
          Chunk chunk{uniform_chunk(Extent::cube(chunk_edge_), each.material), each.version, {}};
          chunk.digest = digest_of(chunk.voxels);
          arrived_.emplace_back(Chunks{uniform->view, {ChunkSnapshot{each.key, std::move(chunk)}}});
        }
        return {};
      }
      if (auto* chunks = cuts_chunks ? std::get_if<Chunks>(&*message) : nullptr) {
        for (ChunkAnswer& each : chunks->chunks)
          arrived_.emplace_back(Chunks{chunks->view, {std::move(each)}});
        return {};
      }
      arrived_.push_back(*std::move(message));
      return {};
    };
    const auto fed = reader_.feed(ByteView(buffer.data(), *got), on_message);
    RUNSTONE_ASSERT(fed.has_value());  // the server never sends a message that its decoder rejects
    return true;
  }

  std::uint32_t views_ = 0;  // sent
  int socket_;
  SocketSource source_;
  std::optional<TlsChannel> tls_;
  std::mutex tls_mutex_;  // held by each call of tls_ after the handshake
  std::atomic<bool> is_open_ = false;
  KeySeed seed_{};
  std::uint16_t chunk_edge_ = 0;
  FrameWriter frames_;
  FrameReader reader_{Sender::server};
  std::deque<Message> arrived_;
};

}  // namespace runstone::test
