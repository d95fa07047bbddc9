// Link: a connection to the server that is made again after a loss. It splits received bytes into
// messages, decodes and verifies them, and sends messages. After a loss it connects again, with
// growing pauses, until it is stopped. Messages carry the number of their connection; those of an
// older connection are dropped. The io_context belongs to the caller, so one thread may run one
// link (NetClient) or a thousand (bots).
// Thread: all calls and callbacks on the one thread that runs the io_context.
#pragma once
#include <asio/io_context.hpp>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "client/net/traffic_meter.hpp"
#include "common/core/channel_binding.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The greatest size of a link's send queue. If it is exceeded, the link closes the connection. The
/// session resumes on the next connection and offers its edits again.
inline constexpr std::size_t kSendBytesMax = 8 * 1024 * 1024;

using ConnectionNumber = std::uint64_t;  // from 1

struct LinkReceived {
  ConnectionNumber connection = 0;
  Message message;
  std::size_t bytes = 0;       // size of the message without frame headers
  TimeUs received_us = 0;      // when its last byte was read, steady clock
  TimeUs unpacked_us = 0;      // when it was decoded and verified
  std::int64_t unpack_ns = 0;  // time spent decoding and verifying
};

struct LinkConfig {
  std::string host;
  std::uint16_t port = 0;
  /// nullopt: the connection is not encrypted.
  std::optional<TlsContext> tls = TlsContext::client();
  // Of NetClient: events that were not taken yet, and the memory of their messages.
  std::size_t events_max = 4096;
  std::size_t event_bytes_max = std::size_t{16} << 20;
  std::int64_t connect_ms_max = 5'000;
  /// The pause between attempts starts with `first` and doubles up to `max`. A random quarter is
  /// added or subtracted.
  std::int64_t pause_ms_first = 100, pause_ms_max = 3'000;
};

/// Counts over all connections since the start.
struct LinkStats {
  std::atomic<std::uint64_t> bytes_received{0}, bytes_sent{0};  // with frame headers, without TLS
  TrafficMeter received, sent;  // messages; received ones count once they are verified
  std::atomic<std::uint64_t> connections{0};
};

/// The callbacks of a link.
class LinkCallbacks {
 public:
  virtual ~LinkCallbacks() = default;
  /// `binding` identifies an encrypted connection.
  virtual void on_connected(ConnectionNumber connection,
                            const std::optional<ChannelBinding>& binding) = 0;
  virtual void on_received(LinkReceived received) = 0;
  /// Offers a message before it is decoded. `body` is 8-aligned and lives until the call returns.
  /// `chunk_edge` is 0 before Welcome. Returns true if the callee verified and handled the message;
  /// then on_received() is not called for it. An error closes the connection.
  virtual Result<bool> on_bytes(MessageKind /*kind*/, ByteView /*body*/,
                                std::uint16_t /*chunk_edge*/, TimeUs /*received_us*/) {
    return false;
  }
  /// `connection` is 0 if no connection could be made.
  virtual void on_disconnected(ConnectionNumber connection, std::string why) = 0;
  /// While this returns true the link reads nothing, and TCP holds the server back.
  virtual bool is_full() { return false; }
};

class Link {
 public:
  /// `io` and `callbacks` must outlive the link. `io` must not run any more when the link is
  /// destroyed.
  Link(asio::io_context& io, LinkConfig config, LinkCallbacks& callbacks);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Starts connecting. Call once.
  void start();
  /// Queues a message. Queued edits are sent before other messages. Does nothing if the connection
  /// has ended.
  void send(ConnectionNumber connection, const EncodedMessage& message);
  /// Closes this connection once all queued messages are sent. The link connects again after a
  /// pause.
  void close(ConnectionNumber connection);
  /// Stops the link after the queued messages are sent, or after `wait_ms`. Then the io_context has
  /// no more work of the link.
  void stop(std::int64_t wait_ms);
  const LinkStats& stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
