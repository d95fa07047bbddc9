// Link: a connection to the server that mends itself. It connects, cuts the bytes that come into messages,
// decodes and verifies them, and sends what it is given; when the connection breaks it connects again, with
// growing pauses, until stopped. Messages carry the number of their connection: what belongs to an older one is
// dropped. It borrows its io_context, so one thread may carry one link (NetClient) or a thousand (bots).
// Threads: all calls and callbacks on the thread that runs the io_context; one thread runs it.
#pragma once
#include <asio/io_context.hpp>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "client/net/traffic_meter.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Bytes to send that a link holds; beyond, the connection is cut: the session resumes and offers its edits
/// again.
inline constexpr std::size_t kSendBytesMax = 8 * 1024 * 1024;

using ConnectionNumber = std::uint64_t;  // from 1

struct NetReceived {
  ConnectionNumber connection = 0;
  Message message;
  std::size_t bytes = 0;       // of the message, without frame headers
  TimeUs received_us = 0;      // steady clock: its last byte was read
  TimeUs unpacked_us = 0;      // decoded and verified
  std::int64_t unpack_ns = 0;  // spent on that
};

struct NetConfig {
  std::string host;
  std::uint16_t port = 0;
  std::size_t events_max = 4096;  // NetClient: events not taken
  std::int64_t connect_ms_max = 5'000;
  std::int64_t pause_ms_first = 100,
               pause_ms_max = 3'000;  // between attempts, doubling, +- a quarter at random
};

/// Counts since the start, over all connections.
struct NetStats {
  std::atomic<std::uint64_t> bytes_received{0}, bytes_sent{0};  // frames included
  TrafficMeter received, sent;  // messages; received: that were verified
  std::atomic<std::uint64_t> connections{0};
};

/// What a link tells.
class LinkEvents {
 public:
  virtual ~LinkEvents() = default;
  virtual void on_connected(ConnectionNumber connection) = 0;
  virtual void on_received(NetReceived received) = 0;
  /// Offers a message before it is decoded; `body` is 8-aligned and lives until the call returns, `chunk_edge` is 0 before
  /// welcome. True: it was verified and taken, and on_received() is not told of it. An error closes the connection.
  virtual Result<bool> on_bytes(FrameClass /*frame_class*/, ByteView /*body*/,
                                std::uint16_t /*chunk_edge*/, TimeUs /*received_us*/) {
    return false;
  }
  /// `connection` 0: no connection came up at all.
  virtual void on_disconnected(ConnectionNumber connection, std::string why) = 0;
  /// While true nothing more is read, and TCP holds the server back.
  virtual bool is_full() { return false; }
};

class Link {
 public:
  /// `io` and `events` must outlive the link, and `io` must not be run any more when the link is destroyed.
  Link(asio::io_context& io, NetConfig config, LinkEvents& events);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Starts connecting. Call once.
  void start();
  /// Queues a message. Of what is queued, edits go first. Ignored if the connection is gone.
  void send(ConnectionNumber connection, const EncodedMessage& message);
  /// Closes this connection once everything queued is sent. Another one is made after a pause.
  void close(ConnectionNumber connection);
  /// Ends for good after sending what is queued, but waits at most `wait_ms` for that. The io_context runs
  /// out of the link's work then.
  void stop(std::int64_t wait_ms);
  const NetStats& stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
