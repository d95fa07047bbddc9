// NetClient: one thread that keeps a connection to the server, cuts its bytes into messages, decodes and
// verifies them, and sends what it is given. When the connection breaks it connects again, with growing
// pauses, until stopped. Messages carry the number of their connection: what belongs to an older one is
// dropped. Bounds: events not taken, `events_max` (full: reading stops and TCP holds the server back); bytes
// to send, kSendBytesMax (full: the connection is cut; the session resumes and offers its edits again).
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr std::size_t kSendBytesMax = 8 * 1024 * 1024;

using ConnectionNumber = std::uint64_t;  // from 1

struct NetConnected {
  ConnectionNumber connection = 0;
};
struct NetReceived {
  ConnectionNumber connection = 0;
  Message message;
  std::size_t bytes = 0;       // of the message, without frame headers
  TimeUs received_us = 0;      // steady clock: its last byte was read
  TimeUs unpacked_us = 0;      // decoded and verified
  std::int64_t unpack_ns = 0;  // spent on that
};
struct NetDisconnected {
  ConnectionNumber connection = 0;  // 0: no connection came up at all
  std::string why;
};
using NetEvent = std::variant<NetConnected, NetReceived, NetDisconnected>;

struct NetConfig {
  std::string host;
  std::uint16_t port = 0;
  std::size_t events_max = 4096;
  std::int64_t connect_ms_max = 5'000;
  std::int64_t pause_ms_first = 100,
               pause_ms_max = 3'000;  // between attempts, doubling, +- a quarter at random
};

/// Counts since the start, over all connections.
struct NetStats {
  std::atomic<std::uint64_t> bytes_received{0}, bytes_sent{0};  // frames included
  std::array<std::atomic<std::uint64_t>, kFrameClassCount> message_bytes_received{};
  std::atomic<std::uint64_t> messages_received{0};
  std::atomic<std::uint64_t> connections{0};
};

class NetClient {
 public:
  /// Starts connecting. `wake` is called from the network thread whenever there is an event to take.
  NetClient(NetConfig config, std::function<void()> wake);
  /// Stops and joins.
  ~NetClient();
  NetClient(const NetClient&) = delete;
  NetClient& operator=(const NetClient&) = delete;

  /// Everything since the last call, in order.
  std::vector<NetEvent> take_events();
  /// Queues a message. Of what is queued, edits go first. Ignored if the connection is gone.
  void send(ConnectionNumber connection, const EncodedMessage& message);
  /// Closes this connection once everything queued is sent. Another one is made after a pause.
  void close(ConnectionNumber connection);
  /// Ends for good after sending what is queued, but waits at most `milliseconds` for that.
  void stop(std::int64_t milliseconds);
  const NetStats& stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
