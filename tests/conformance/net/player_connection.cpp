#include "tests/conformance/net/player_connection.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "protocol/codec/message_table.hpp"

namespace runstone::conformance {
namespace {

/// How long the client may leave the socket full.
constexpr int kSendMs = 20'000;

}  // namespace

PlayerConnection::PlayerConnection(int socket, const TlsContext* tls, std::uint16_t edge)
    : socket_(socket), is_encrypted_(tls != nullptr), edge_(edge), source_(socket) {
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (is_encrypted_) tls_.emplace(TlsChannel::accept(*tls, source_));
}

PlayerConnection::~PlayerConnection() { cut(); }

bool PlayerConnection::continue_opening() {
  if (is_open_ || !is_encrypted_) return is_open_ = true;
  const TlsChannel::Status status = tls_->handshake();
  send_to_socket(std::exchange(tls_->output(), {}));
  is_open_ = status == TlsChannel::Status::done;
  is_ended_ = is_ended_ || status == TlsChannel::Status::failed || source_.is_at_end();
  if (status == TlsChannel::Status::failed) fault_ = "the TLS handshake failed: " + tls_->error();
  return is_open_;
}

std::optional<ChannelBinding> PlayerConnection::binding() const {
  return is_encrypted_ ? std::optional(tls_->binding()) : std::nullopt;
}

void PlayerConnection::send(const Message& message) { send(encode_message(message)); }

void PlayerConnection::send(const EncodedMessage& message) {
  queue(message);
  while (send_fragments()) {
  }
}

void PlayerConnection::queue(const EncodedMessage& message) {
  static_cast<void>(queue_.push(message));
}

bool PlayerConnection::send_fragments(std::size_t chunk_body_max) {
  SendQueue::Batch batch;
  if (!queue_.take(batch, chunk_body_max)) return false;
  Bytes bytes;
  bytes.reserve(batch.bytes);
  for (const SendQueue::Batch::Piece& piece : batch.pieces) {
    bytes.insert(bytes.end(), piece.header.begin(), piece.header.end());
    bytes.insert(bytes.end(), piece.body.begin(), piece.body.end());
  }
  frames_sent_ += batch.pieces.size();
  chunk_bytes_sent_ += batch.chunk_bytes;
  send_bytes(bytes);
  return true;
}

void PlayerConnection::send_bytes(ByteView bytes) {
  if (!is_encrypted_) return send_to_socket(bytes);
  if (tls_->write(bytes)) send_to_socket(std::exchange(tls_->output(), {}));
}

FrameHeader PlayerConnection::next_header(MessageKind kind, std::size_t body_bytes,
                                          bool more) const {
  FrameWriter writer;
  for (std::uint64_t i = 0; i < frames_sent_; ++i) static_cast<void>(writer.next(kind, 1, false));
  return writer.next(kind, body_bytes, more);
}

void PlayerConnection::send_unfinished(MessageKind kind, std::size_t body_bytes) {
  const FrameHeader header = next_header(kind, body_bytes, true);
  Bytes bytes(header.begin(), header.end());
  bytes.resize(bytes.size() + body_bytes);
  ++frames_sent_;
  send_bytes(bytes);
}

void PlayerConnection::cut() {
  if (socket_ < 0) return;
  source_.disconnect();
  ::close(socket_);
  socket_ = -1;
  is_ended_ = true;
}

std::optional<Message> PlayerConnection::next() {
  if (arrived_.empty() && !is_ended_) read();
  if (arrived_.empty()) return std::nullopt;
  Message message = std::move(arrived_.front());
  arrived_.pop_front();
  return message;
}

void PlayerConnection::read() {
  Bytes buffer(64 * 1024);
  std::size_t bytes = 0;
  if (is_encrypted_) {
    const TlsChannel::Status status = tls_->read(buffer, bytes);
    if (status != TlsChannel::Status::done) {
      bytes = 0;
      is_ended_ = status != TlsChannel::Status::wants_input || source_.is_at_end() ||
                  static_cast<bool>(source_.error());
    }
  } else {
    bytes = source_.receive(buffer);
    is_ended_ = source_.is_at_end() || static_cast<bool>(source_.error());
  }
  if (bytes == 0) return;
  const auto fed =
      reader_.feed(ByteView(buffer.data(), bytes),
                   [this](MessageKind kind, ByteView body) { return take(kind, body); });
  if (!fed && fault_.empty()) fault_ = std::string("a frame is malformed: ") + fed.error().what;
}

Result<void> PlayerConnection::take(MessageKind kind, ByteView bytes) {
  auto message = decode_message(Sender::client, kind, bytes, edge_);
  if (!message) {
    fault_ = std::string(info_of(kind).name) + " is malformed: " + message.error().what;
    return failure(message.error());
  }
  arrived_.push_back(*std::move(message));
  return {};
}

void PlayerConnection::send_to_socket(ByteView bytes) {
  while (!bytes.empty() && socket_ >= 0) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    if (errno == EINTR) continue;
    pollfd wait{socket_, POLLOUT, 0};
    if (errno != EAGAIN || ::poll(&wait, 1, kSendMs) <= 0) return;  // the next read finds the end
  }
}

}  // namespace runstone::conformance
