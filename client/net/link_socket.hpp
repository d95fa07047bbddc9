// LinkSocket: the socket of a link, with or without TLS, and with or without a WebSocket in it.
// Thread: the one that runs the io_context. At most one read and one write are under way.
#pragma once
#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/error_code.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <cstddef>
#include <optional>
#include <string>

#include "client/net/web_socket.hpp"
#include "common/core/bytes.hpp"
#include "common/tls/tls_channel.hpp"

namespace runstone {

class LinkSocket {
 public:
  explicit LinkSocket(asio::io_context& io) : tcp_(io) {}

  /// Replaces the socket by a new one. Bytes are not encrypted before secure() is called.
  void reset();
  /// The socket, to be connected.
  asio::ip::tcp::socket& tcp() { return tcp_; }
  void set_no_delay();
  /// Performs the TLS handshake with the server `host`. Returns an empty text, or why it failed.
  asio::awaitable<std::string> secure(const TlsContext& context, const std::string& host);
  /// Opens a WebSocket. Bytes that are read and written later are the contents of its messages, one
  /// frame of the protocol each. `host`: HOST:PORT. Returns an empty text, or why it failed.
  asio::awaitable<std::string> open_websocket(const std::string& host, const std::string& path);
  /// Identifies the connection with the server after secure(). TLS of a WebSocket ends at the
  /// gateway, so a WebSocket has none.
  std::optional<ChannelBinding> binding() const { return web_ ? std::nullopt : binding_; }
  /// Returns why the other end of a WebSocket closed it, or an empty text.
  const std::string& closing_words() const { return closing_words_; }

  /// Trivially destructible, because g++ 12 destroys other values in a co_await expression twice.
  struct Read {
    asio::error_code error;
    std::size_t bytes = 0;  // at least 1 without an error
  };
  asio::awaitable<Read> read_some(asio::mutable_buffer into);
  /// Writes all bytes, which must live until the call ends. To a WebSocket they must be whole
  /// frames.
  asio::awaitable<asio::error_code> write(ByteView bytes);
  /// Closes both directions. Calls under way fail.
  void close();

 private:
  /// The records that were received and not read yet.
  struct Records final : TlsSource {
    Bytes buffer;
    ByteView unread;
    std::size_t receive(std::span<std::uint8_t> into) override;
  };
  /// Ends the WebSocket behind the messages that have come.
  void end_reading(const std::string& words);
  asio::awaitable<Read> read_below(asio::mutable_buffer into);
  asio::awaitable<asio::error_code> write_below(ByteView bytes);
  asio::awaitable<asio::error_code> flush();
  /// Receives records. Requires that all earlier ones were read.
  asio::awaitable<asio::error_code> receive();

  asio::ip::tcp::socket tcp_;
  Records records_;
  std::optional<TlsChannel> tls_;  // nullopt: no encryption
  std::optional<ChannelBinding> binding_;
  Bytes sending_;
  std::optional<WebSocketCodec> web_;  // nullopt: no WebSocket
  Bytes received_;                     // by the WebSocket
  Bytes contents_;                     // of its messages, and how much of them was read
  std::size_t contents_read_ = 0;
  Bytes messages_;         // to be sent
  bool is_ended_ = false;  // the WebSocket has ended
  std::string closing_words_;
};

}  // namespace runstone
