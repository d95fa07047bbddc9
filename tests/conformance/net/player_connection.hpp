// PlayerConnection: the server's end of one connection, with the codec and the send queue of the
// real server. It sends messages by their classes, single fragments of them, and also bytes that an
// honest server never sends. It reads, verifies and decodes what the client sends. Thread: one.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/channel_binding.hpp"
#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"
#include "server/net/send_queue.hpp"

namespace runstone::conformance {

class PlayerConnection {
 public:
  /// Takes the socket. `tls`: nullptr for a connection without encryption. `edge`: of the world.
  PlayerConnection(int socket, const TlsContext* tls, std::uint16_t edge);
  ~PlayerConnection();
  PlayerConnection(const PlayerConnection&) = delete;
  PlayerConnection& operator=(const PlayerConnection&) = delete;

  int descriptor() const { return socket_; }
  /// Continues the TLS handshake with what has arrived. Returns true once messages can be exchanged.
  bool continue_opening();
  /// Returns what identifies an encrypted connection.
  std::optional<ChannelBinding> binding() const;

  /// Queues a message and sends all that is queued.
  void send(const Message& message);
  void send(const EncodedMessage& message);
  /// Queues a message. send_fragments() sends it.
  void queue(const EncodedMessage& message);
  /// Sends fragments by priority, with at most one of the class chunks, whose body has at most
  /// `chunk_body_max` bytes. Returns false if nothing was queued.
  bool send_fragments(std::size_t chunk_body_max = kFragmentBytesMax);
  /// Sends bytes as they are, behind what was sent.
  void send_bytes(ByteView bytes);
  /// Returns the header that the next frame has. The sender may spoil it and send it by send_bytes().
  FrameHeader next_header(MessageKind kind, std::size_t body_bytes, bool more = false) const;
  /// Sends a fragment of zeros, of a message that goes on.
  void send_unfinished(MessageKind kind, std::size_t body_bytes);
  /// Closes the connection at once, without the end of TLS.
  void cut();

  /// Reads what has arrived. Returns the next message, or nullopt if none is complete.
  std::optional<Message> next();
  /// Returns true once the client has ended the connection and all messages were taken.
  bool is_ended() const { return is_ended_ && arrived_.empty(); }
  /// Returns the rule that the client broke in frames or messages, or an empty text.
  const std::string& fault() const { return fault_; }
  /// Returns the bytes of frames of the class chunks that were sent.
  std::uint64_t chunk_bytes_sent() const { return chunk_bytes_sent_; }

 private:
  void read();
  void send_to_socket(ByteView bytes);
  Result<void> take(MessageKind kind, ByteView bytes);

  int socket_;
  const bool is_encrypted_;
  const std::uint16_t edge_;
  SocketSource source_;
  std::optional<TlsChannel> tls_;
  bool is_open_ = false, is_ended_ = false;
  SendQueue queue_{SendLimits{SIZE_MAX, SIZE_MAX, SIZE_MAX, SIZE_MAX, SIZE_MAX, SIZE_MAX,
                              std::size_t{32} * 1024}};
  std::uint64_t frames_sent_ = 0, chunk_bytes_sent_ = 0;
  FrameReader reader_{Sender::client};
  std::deque<Message> arrived_;
  std::string fault_;
};

}  // namespace runstone::conformance
