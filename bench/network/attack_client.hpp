// AttackClient: one raw connection to a server that may do what the product's clients never do:
// not read, read one byte, send bytes without meaning. It performs the handshake correctly with a
// key of its own, which anybody can make. It decodes only the handshake and the goodbye. The TLS
// handshake begins with the first flush(). Calls block only for the given times. Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bench/network/descriptor.hpp"
#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone::bench {

class AttackClient {
 public:
  /// Starts to connect to 127.0.0.1:`port` from the IPv4 address `from` (host order, of
  /// 127.0.0.0/8), over TLS if `context` is not null. `receive_bytes` is the size of the socket's
  /// buffer; 0 leaves it to the kernel.
  AttackClient(std::uint16_t port, std::uint32_t from, const TlsContext* context,
               int receive_bytes = 0);

  /// The features that attackers offer. Receive acknowledgements are left out, so that the server
  /// does not pace its sending, and names are left out, so that all attackers may have one name.
  static constexpr std::uint64_t kFeatures = kFeaturesKnown & ~(kFeatureReceiveAck | kFeatureNames);

  /// Queues a hello with a key drawn from `identity`, as this instance.
  void queue_hello(std::uint64_t identity, ClientInstance instance,
                   std::uint64_t features = kFeatures);
  /// Reads what is there, and answers a welcome if `answers` is true. It does not flush.
  void continue_handshake(bool answers);
  /// Performs the handshake with a key drawn from `identity`, as this instance. Returns false if
  /// the server ended the connection, or after `wait_ms`.
  bool open_session(std::uint64_t identity, ClientInstance instance, int wait_ms,
                    std::uint64_t features = kFeatures);

  /// Queues a message; flush() sends. Bytes are sent unchanged, outside of any frame.
  /// A view gets the number that follows the last one.
  void queue(Message message) {
    if (auto* view = std::get_if<View>(&message)) view->number = ++views_;
    queue(encode_message(message));
  }
  void queue(const EncodedMessage& message) { frames_.append(message, text_); }
  void queue_bytes(ByteView bytes);
  std::size_t queued() const { return text_.size() + out_.size() - sent_; }
  /// Sends as much as the socket takes now, at most `bytes_max`.
  void flush(std::size_t bytes_max = SIZE_MAX);
  /// Reads what is there now, at most `bytes_max`.
  void read(std::size_t bytes_max = 256 * 1024);
  /// Waits at most `wait_ms` until it can send queued bytes or, if `reads` is true, until there is
  /// something to read.
  void wait(int wait_ms, bool reads);

  void shutdown_send();

  int socket() const { return socket_.get(); }
  /// Returns false after the server's goodbye, after it closed the connection, and after an error.
  bool is_open() const { return is_open_ && !goodbye_; }
  /// Returns true if messages can be exchanged: the TLS handshake is complete.
  bool is_encrypted() const { return !tls_ || is_encrypted_; }
  bool is_welcome() const { return is_welcome_; }
  bool has_session() const { return has_session_; }
  /// Returns the session's Welcome; empty before it has come.
  const Welcome& welcome() const { return welcome_; }
  /// Returns what the server said or did: "flooding: more messages than the rate allows", "closed",
  /// "still connected".
  std::string ending() const;

  std::uint64_t bytes_sent() const { return bytes_sent_; }
  std::uint64_t bytes_received() const { return bytes_received_; }

 private:
  Result<void> take(MessageKind kind, ByteView body);
  /// Continues the TLS handshake and encrypts queued text.
  void encrypt();
  /// Reads what is there, of `allowed` bytes of the connection. Returns 0 if nothing is, and at the
  /// end.
  std::size_t receive(std::span<std::uint8_t> into, std::size_t& allowed);

  Descriptor socket_;
  bool is_open_ = false, has_session_ = false;
  std::uint32_t views_ = 0;  // queued
  FrameWriter frames_;
  FrameReader reader_{Sender::server};
  SocketSource source_;
  std::optional<TlsChannel> tls_;
  bool is_encrypted_ = false;  // the TLS handshake is complete
  Bytes text_;                 // not encrypted yet
  Bytes out_;
  std::size_t sent_ = 0;  // of out_
  std::uint16_t chunk_edge_ = 0;
  Hello hello_;
  KeyPair keys_;
  bool is_welcome_ = false, has_answered_ = false;
  Welcome welcome_;
  std::optional<Goodbye> goodbye_;
  std::uint64_t bytes_sent_ = 0, bytes_received_ = 0;
};

}  // namespace runstone::bench
