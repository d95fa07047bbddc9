// MessageStream: the client's end of one connection, as messages on top of a stream of bytes. It
// splits the bytes of the server into messages, decodes and verifies them, acknowledges chunk
// bytes, and makes frames of the messages to send. A socket, a WebSocket or a test carries the
// bytes. Pure: times and the clock are arguments. Thread: one.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>

#include "client/stream/receive_ack_scheduler.hpp"
#include "client/stream/traffic_meter.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The greatest size of a connection's send queue. If it is exceeded, the connection ends. The
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

/// Counts over all connections since the start.
struct LinkStats {
  std::atomic<std::uint64_t> bytes_received{0}, bytes_sent{0};  // with frame headers, without TLS
  TrafficMeter received, sent;  // messages; received ones count once they are verified
  std::atomic<std::uint64_t> connections{0};
};

/// Gets the messages of a stream.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  virtual void on_received(LinkReceived received) = 0;
  /// Offers a message before it is decoded. `body` is 8-aligned and lives until the call returns.
  /// `chunk_edge` is 0 before Welcome. Returns true if the callee verified and handled the message;
  /// then on_received() is not called for it. An error closes the connection.
  virtual Result<bool> on_bytes(MessageKind /*kind*/, ByteView /*body*/,
                                std::uint16_t /*chunk_edge*/, TimeUs /*received_us*/) {
    return false;
  }
};

class MessageStream {
 public:
  using ClockNs = std::int64_t (*)();  // steady, nanoseconds; measures how long decoding takes

  /// `stats` and `sink` must outlive the stream.
  MessageStream(ConnectionNumber connection, LinkStats& stats, MessageSink& sink, ClockNs clock)
      : connection_(connection), stats_(stats), sink_(sink), clock_(clock) {}

  /// Takes bytes of the server, in pieces of any size. Fails if they break a rule; the connection
  /// is then to be closed.
  Result<void> receive(ByteView bytes, TimeUs received_us);
  /// Queues an acknowledgement of the chunk bytes read if one is due. Returns when the next one is
  /// due if no more bytes come, or nullopt if none is.
  std::optional<TimeUs> acknowledge(TimeUs now_us);

  /// Queues a message. Queued edits are written before other messages. Returns false if the queue
  /// is full, which ends the connection.
  bool queue(const EncodedMessage& message);
  bool has_output() const { return !edits_.empty() || !others_.empty(); }
  /// Appends queued messages as frames to `out`, in the order in which they are to be sent, until
  /// `out` has `bytes_max` or more.
  void write(Bytes& out, std::size_t bytes_max);

 private:
  const ConnectionNumber connection_;
  LinkStats& stats_;
  MessageSink& sink_;
  const ClockNs clock_;
  FrameReader reader_{Sender::server};
  FrameWriter writer_;
  std::uint16_t chunk_edge_ = 0;  // of this connection's world; 0 before Welcome
  std::uint64_t features_ = 0;    // in force; none before Welcome
  /// Frames read up to the last message of each class.
  std::array<std::uint64_t, kFrameClassCount> frames_before_{};
  ReceiveAckScheduler receive_acks_;
  std::deque<EncodedMessage> edits_, others_;
  std::size_t queued_bytes_ = 0;
};

}  // namespace runstone
