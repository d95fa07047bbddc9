// ByteStream: the bytes under a session: TCP today; TLS or a WebSocket slip in here. Calls come from the
// session's strand; at most one read and one write are under way at a time.
#pragma once
#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/error_code.hpp>
#include <asio/ip/tcp.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

/// Trivially destructible, as values in a co_await expression have to be (g++ 12 frees others twice).
struct IoResult {
  asio::error_code error;
  std::size_t bytes = 0;
  std::int64_t call_ns = 0;  // of a write: processor time of the calls themselves
};

/// What may be written and leaves at once, instead of waiting in the kernel.
struct StreamRoom {
  std::size_t bytes = SIZE_MAX;
  TimeUs again_us = 0;  // where there is none: how long to wait before the next question
};

class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Some bytes; an error at the end of the stream.
  virtual asio::awaitable<IoResult> read_some(asio::mutable_buffer into) = 0;
  /// All bytes of all buffers. The vector must live until the call ends.
  virtual asio::awaitable<IoResult> write(const std::vector<asio::const_buffer>& buffers) = 0;
  /// For terrain: what waits in the kernel is overtaken by no edit. Some 1 us.
  virtual StreamRoom room() = 0;
  /// No more writes: the peer sees the end of the stream after what was written.
  virtual void shutdown_send() = 0;
  /// Ends both directions; calls under way return an error.
  virtual void close() = 0;
  /// "127.0.0.1:40312", for log lines.
  virtual std::string peer() const = 0;
};

/// TCP with TCP_NODELAY and a small TCP_NOTSENT_LOWAT, so that little terrain lies between an edit and the
/// wire.
std::unique_ptr<ByteStream> make_tcp_stream(asio::ip::tcp::socket socket,
                                            std::size_t notsent_bytes);

}  // namespace runstone
