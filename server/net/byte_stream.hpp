// ByteStream: the byte stream of a session. TCP implements it, TLS over TCP, and a Unix socket.
// Threads: the session's strand. At most one read and one write are under way at a time.
#pragma once
#include <asio/any_io_executor.hpp>
#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/error_code.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/local/stream_protocol.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/core/address_block.hpp"
#include "common/core/bytes.hpp"
#include "common/core/channel_binding.hpp"
#include "common/core/ids.hpp"
#include "common/tls/tls_context.hpp"
#include "server/limits/address_form.hpp"

namespace runstone {

/// Must be trivially destructible, because g++ 12 destroys other values in a co_await expression
/// twice.
struct IoResult {
  asio::error_code error;
  std::size_t bytes = 0;
  std::size_t received =
      0;                  // of a read: bytes of the connection, which TLS makes more than `bytes`
  bool has_rest = false;  // of write_now(): write_rest() must follow
};

/// How ByteStream::open() ended.
enum class StreamStart {
  open,
  failed,
  not_encrypted,  // the peer does not speak TLS; it was told so
};

/// The bytes that may be written and leave at once, without waiting in the kernel.
struct StreamRoom {
  std::size_t bytes = SIZE_MAX;
  TimeUs again_us = 0;  // if there is no room: how long to wait before asking again
};

class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Makes the stream ready to read and write. It is called once, before the other calls.
  virtual asio::awaitable<StreamStart> open() = 0;
  /// Returns why open() failed, for log lines.
  virtual std::string failure() const { return {}; }
  /// Returns what identifies an encrypted connection; nullopt without encryption.
  virtual std::optional<ChannelBinding> binding() const { return std::nullopt; }
  /// Reads what has come. The result may be empty after bytes that are none of the text. Fails at
  /// the end of the stream.
  virtual asio::awaitable<IoResult> read_some(asio::mutable_buffer into) = 0;
  /// Writes what the connection takes at once. If that is not all, `has_rest` of the result is true,
  /// and write_rest() must follow. The bytes must stay in place until it has ended. The last
  /// `terrain_bytes` bytes are terrain: the peer can read the bytes before them without them.
  virtual IoResult write_now(std::span<const asio::const_buffer> buffers,
                             std::size_t terrain_bytes) = 0;
  /// Writes the rest of the last write_now(), and waits for the peer where it must.
  virtual asio::awaitable<IoResult> write_rest() = 0;
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

/// Makes a stream over a Unix socket, through which a gateway speaks for the client at this
/// endpoint.
std::unique_ptr<ByteStream> make_local_stream(asio::local::stream_protocol::socket socket,
                                              const asio::ip::tcp::endpoint& client,
                                              AddressForm log_form);

/// Makes the server's end of a stream over TLS and TCP. The costly steps of the handshake run on
/// `handshakes`. A peer that does not speak TLS gets `plain_answer`, unencrypted.
std::unique_ptr<ByteStream> make_tls_stream(asio::ip::tcp::socket socket, std::size_t notsent_bytes,
                                            AddressForm log_form, const TlsContext& context,
                                            asio::any_io_executor handshakes, Bytes plain_answer);

/// Makes the client's end of a stream over TLS and TCP. `host`: the name or the address of the
/// server, see TlsChannel::connect().
std::unique_ptr<ByteStream> make_tls_client_stream(asio::ip::tcp::socket socket,
                                                   std::size_t notsent_bytes, AddressForm log_form,
                                                   const TlsContext& context,
                                                   const std::string& host,
                                                   asio::any_io_executor handshakes);

}  // namespace runstone
