#include "bench/network/attack_client.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <utility>
#include <variant>

#include "protocol/codec/message_table.hpp"
#include "protocol/limits.hpp"

namespace runstone::bench {
namespace {

using Clock = std::chrono::steady_clock;

sockaddr_in endpoint(std::uint32_t address, std::uint16_t port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(port);
  out.sin_addr.s_addr = htonl(address);
  return out;
}

bool would_block(int error) {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINPROGRESS;
}

void set_option(int socket, int level, int name, int value) {
  // The attack also works without this option.
  (void)::setsockopt(socket, level, name, &value, sizeof value);
}

KeyPair key_of(std::uint64_t identity) {
  KeySeed seed{};
  for (std::size_t i = 0; i < sizeof identity; ++i)
    seed[i] = static_cast<std::uint8_t>(identity >> (8 * i));
  return key_pair_of(seed);
}

}  // namespace

AttackClient::AttackClient(std::uint16_t port, std::uint32_t from, const TlsContext* context,
                           int receive_bytes)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  if (!socket_) return;
  if (receive_bytes > 0) set_option(socket_.get(), SOL_SOCKET, SO_RCVBUF, receive_bytes);
  // With this option a port is in use only together with the server's address, and it is free again
  // at once. An attack has thousands of sockets.
  set_option(socket_.get(), IPPROTO_IP, IP_BIND_ADDRESS_NO_PORT, 1);
  const linger no_wait{1, 0};
  (void)::setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &no_wait, sizeof no_wait);
  const sockaddr_in here = endpoint(from, 0), there = endpoint(INADDR_LOOPBACK, port);
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) return;
  is_open_ =
      ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0 ||
      would_block(errno);
  if (context == nullptr) return;
  source_ = SocketSource(socket_.get());
  tls_.emplace(TlsChannel::connect(*context, source_, "127.0.0.1"));
}

void AttackClient::queue_hello(std::uint64_t identity, ClientInstance instance,
                               std::uint64_t features) {
  keys_ = key_of(identity);
  hello_.key = keys_.public_key;
  hello_.instance = instance;
  hello_.name = "mallory";
  hello_.features = features;
  queue(hello_);
}

void AttackClient::continue_handshake(bool answers) {
  read();
  if (!is_welcome_ || !answers || std::exchange(has_answered_, true)) return;
  const auto binding = tls_ ? std::optional(tls_->binding()) : std::nullopt;
  queue(ClientAuth{sign(keys_, client_transcript(hello_, welcome_, binding)), {}});
}

bool AttackClient::open_session(std::uint64_t identity, ClientInstance instance, int wait_ms,
                                std::uint64_t features) {
  queue_hello(identity, instance, features);
  const auto end = Clock::now() + std::chrono::milliseconds(wait_ms);
  while (is_open() && !has_session_ && Clock::now() < end) {
    flush();
    wait(1, true);
    continue_handshake(true);
  }
  return is_open() && has_session_;
}

void AttackClient::queue_bytes(ByteView bytes) {
  text_.insert(text_.end(), bytes.begin(), bytes.end());
}

void AttackClient::encrypt() {
  if (!tls_) {
    out_.insert(out_.end(), text_.begin(), text_.end());
    text_.clear();
    return;
  }
  if (!is_encrypted_) {
    const TlsChannel::Status status = tls_->handshake();
    is_encrypted_ = status == TlsChannel::Status::done;
    if (!is_encrypted_ && status != TlsChannel::Status::wants_input) is_open_ = false;
  }
  if (is_encrypted_) {
    is_open_ = tls_->write(text_) && is_open_;
    text_.clear();
  }
  Bytes& records = tls_->output();
  out_.insert(out_.end(), records.begin(), records.end());
  records.clear();
}

void AttackClient::flush(std::size_t bytes_max) {
  if (is_open_) encrypt();
  while (is_open_ && out_.size() > sent_ && bytes_max > 0) {
    const std::size_t wanted = std::min(out_.size() - sent_, bytes_max);
    const ssize_t count = ::send(socket_.get(), out_.data() + sent_, wanted, MSG_NOSIGNAL);
    if (count < 0) {
      if (would_block(errno) || errno == ENOTCONN) return;
      // The server's goodbye may still be in the socket.
      read();
      is_open_ = false;
      return;
    }
    sent_ += static_cast<std::size_t>(count);
    bytes_max -= static_cast<std::size_t>(count);
    bytes_sent_ += static_cast<std::uint64_t>(count);
  }
  if (out_.size() > sent_) return;
  out_.clear();
  sent_ = 0;
}

std::size_t AttackClient::receive(std::span<std::uint8_t> into, std::size_t& allowed) {
  if (!tls_) {
    const ssize_t count = ::recv(socket_.get(), into.data(), std::min(into.size(), allowed), 0);
    if (count < 0 && (would_block(errno) || errno == ENOTCONN)) return 0;
    if (count <= 0) is_open_ = false;
    const std::size_t bytes = count > 0 ? static_cast<std::size_t>(count) : 0;
    allowed -= bytes;
    bytes_received_ += bytes;
    return bytes;
  }
  source_.allow(allowed);
  std::size_t bytes = 0;
  auto status = TlsChannel::Status::done;
  if (!is_encrypted_) {
    status = tls_->handshake();
    is_encrypted_ = status == TlsChannel::Status::done;
  }
  if (is_encrypted_) status = tls_->read(into, bytes);
  const std::size_t received = source_.take_count();
  allowed -= received;
  bytes_received_ += received;
  const bool is_broken = source_.error() && source_.error().value() != ENOTCONN;
  if (status == TlsChannel::Status::wants_input) {
    if (source_.is_at_end() || is_broken) is_open_ = false;
  } else if (status != TlsChannel::Status::done) {
    is_open_ = false;
  }
  return bytes;
}

void AttackClient::read(std::size_t bytes_max) {
  std::array<std::uint8_t, 16 * 1024> buffer;
  for (std::size_t allowed = bytes_max; is_open_ && allowed > 0;) {
    const std::size_t count = receive(buffer, allowed);
    if (count == 0) return;
    const auto fed =
        reader_.feed(ByteView(buffer.data(), count),
                     [this](MessageKind kind, ByteView body) { return take(kind, body); });
    if (!fed) is_open_ = false;
  }
}

void AttackClient::wait(int wait_ms, bool reads) {
  pollfd wanted{socket_.get(), 0, 0};
  if (reads) wanted.events |= POLLIN;
  if (queued() > 0) wanted.events |= POLLOUT;
  (void)::poll(&wanted, 1, wait_ms);
}

void AttackClient::shutdown_send() { ::shutdown(socket_.get(), SHUT_WR); }

std::string AttackClient::ending() const {
  if (!goodbye_) return is_open_ ? "still connected" : "closed without a word";
  return std::string(to_string(goodbye_->reason)) + ": " + goodbye_->text;
}

// Terrain and commits are only counted: decoding them would slow the attack down.
Result<void> AttackClient::take(MessageKind kind, ByteView body) {
  const FrameClass frame_class = info_of(kind).frame_class;
  if (frame_class == FrameClass::chunks || (frame_class == FrameClass::edits && has_session_))
    return {};
  auto message = decode_message(Sender::server, kind, body, chunk_edge_);
  if (!message) return failure(message.error());
  if (auto* welcome = std::get_if<Welcome>(&*message)) {
    chunk_edge_ = welcome->chunk_edge;
    welcome_ = std::move(*welcome);
    is_welcome_ = true;
  } else if (std::holds_alternative<SessionAccepted>(*message)) {
    has_session_ = true;
  } else if (auto* goodbye = std::get_if<Goodbye>(&*message)) {
    goodbye_ = std::move(*goodbye);
  }
  return {};
}

}  // namespace runstone::bench
