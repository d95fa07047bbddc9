// ByteStream: the byte stream of a session. TCP implements it.
// Threads: the session's strand. At most one read and one write are under way at a time.
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
#include "server/limits/address_block.hpp"
#include "server/limits/address_form.hpp"

namespace runstone {

/// Must be trivially destructible, because g++ 12 destroys other values in a co_await expression
/// twice.
struct IoResult {
  asio::error_code error;
  std::size_t bytes = 0;
  std::int64_t call_ns = 0;  // of a write: processor time of the system calls
};

/// The bytes that may be written and leave at once, without waiting in the kernel.
struct StreamRoom {
  std::size_t bytes = SIZE_MAX;
  TimeUs again_us = 0;  // if there is no room: how long to wait before asking again
};

class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Reads at least one byte. Fails at the end of the stream.
  virtual asio::awaitable<IoResult> read_some(asio::mutable_buffer into) = 0;
  /// Writes all bytes of all buffers. The vector must live until the call ends.
  virtual asio::awaitable<IoResult> write(const std::vector<asio::const_buffer>& buffers) = 0;
  /// Returns the room for terrain. An edit cannot overtake bytes that wait in the kernel. Cost:
  /// about 1 us.
  virtual StreamRoom room() = 0;
  /// Ends sending: the peer gets the end of the stream behind the bytes that were written.
  virtual void shutdown_send() = 0;
  /// Closes both directions. Calls under way fail.
  virtual void close() = 0;
  /// Returns the address for log lines, such as "127.0.0.1:40312" (peer_text.hpp).
  virtual std::string peer() const = 0;
  /// Returns the address that pays for the connection.
  virtual AddressBlock address() const { return {}; }
};

/// Makes a stream over TCP with TCP_NODELAY and TCP_NOTSENT_LOWAT = `notsent_bytes`, so that little
/// terrain waits in the kernel before an edit. `log_form`: of peer().
std::unique_ptr<ByteStream> make_tcp_stream(asio::ip::tcp::socket socket, std::size_t notsent_bytes,
                                            AddressForm log_form);

}  // namespace runstone
