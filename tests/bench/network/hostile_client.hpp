// HostileClient: one raw connection to a server that may do what no client of ours does: never read, read one byte, send
// bytes that mean nothing. It speaks the handshake honestly, with a key of its own, for anyone can make one. Of what it
// reads it decodes only handshake and goodbye. Nothing blocks but for the times given. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/bench/network/descriptor.hpp"

namespace runstone::bench {

class HostileClient {
 public:
  /// Connects to 127.0.0.1:`port` from the IPv4 address `from` (host order, of 127.0.0.0/8), without waiting. `receive_bytes`: of
  /// the socket's buffer, 0: as the kernel likes.
  HostileClient(std::uint16_t port, std::uint32_t from, int receive_bytes = 0);

  /// The handshake with a key drawn from `identity`. It offers commands, but not to say what it read: so nothing paces what it is
  /// sent. False: the server ended it, or took longer than `wait_ms`.
  bool open_session(std::uint64_t identity, int wait_ms);

  /// Queues; flush() sends. Bytes are sent as they are, outside of any frame.
  void queue(const Message& message) { queue(encode_message(message)); }
  void queue(const EncodedMessage& message) { frames_.append(message, out_); }
  void queue_bytes(ByteView bytes);
  std::size_t queued() const { return out_.size() - sent_; }
  /// Sends what the socket takes now.
  void flush();
  /// Reads what there is now, `bytes_max` at most.
  void read(std::size_t bytes_max = 256 * 1024);
  /// Waits until it can send what is queued or there is something to read, `wait_ms` at most. `reads`: whether the latter counts.
  void wait(int wait_ms, bool reads);

  void shutdown_send();

  /// Until the server said goodbye, closed it, or it broke.
  bool is_open() const { return is_open_ && !goodbye_; }
  /// Of the session; before it is open, empty.
  const Welcome& welcome() const { return welcome_; }
  /// What the server said or did: "flooding: more messages than the rate allows", "closed", "still connected".
  std::string ending() const;

  std::uint64_t bytes_sent() const { return bytes_sent_; }
  std::uint64_t bytes_received() const { return bytes_received_; }

 private:
  Result<void> take(FrameClass frame_class, ByteView body);

  Descriptor socket_;
  bool is_open_ = false, has_session_ = false;
  FrameWriter frames_;
  FrameReader reader_{Sender::server};
  Bytes out_;
  std::size_t sent_ = 0;  // of out_
  std::uint16_t chunk_edge_ = 0;
  std::optional<Welcome> came_;
  Welcome welcome_;
  std::optional<Goodbye> goodbye_;
  std::uint64_t bytes_sent_ = 0, bytes_received_ = 0;
};

}  // namespace runstone::bench
