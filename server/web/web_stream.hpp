// WebStream: a TCP connection of a browser, with or without TLS, as a stream for Beast. One type for
// both keeps Beast's templates from being compiled twice.
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <optional>

#include "common/core/ids.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {

class WebStream {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  /// Beast's stream joins the buffers of a write into one record. That of Asio makes a record of each,
  /// so the header of a frame would be a record and a packet of its own.
  using Tls = boost::beast::ssl_stream<Socket>;
  using next_layer_type = Socket;
  using executor_type = Socket::executor_type;

  /// `context`: null for a stream without TLS. It must outlive the stream.
  WebStream(Socket socket, boost::asio::ssl::context* context) {
    if (context == nullptr) {
      plain_.emplace(std::move(socket));
    } else {
      tls_.emplace(std::move(socket), *context);
    }
  }
  WebStream(const WebStream&) = delete;
  WebStream& operator=(const WebStream&) = delete;

  // These functions make the class a stream for Beast.
  executor_type get_executor() { return next_layer().get_executor(); }
  Socket& next_layer() { return tls_ ? tls_->next_layer() : *plain_; }
  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    if (tls_) return tls_->async_read_some(buffers, std::forward<Token>(token));
    return plain_->async_read_some(buffers, std::forward<Token>(token));
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    if (tls_) return tls_->async_write_some(buffers, std::forward<Token>(token));
    return plain_->async_write_some(buffers, std::forward<Token>(token));
  }

  /// Returns the TLS layer, or null.
  Tls* tls() { return tls_ ? &*tls_ : nullptr; }

  /// Closes the connection. Calls under way fail.
  void close() {
    boost::system::error_code ignored;
    next_layer().close(ignored);
  }
  /// Lets the connection live for so long, unless it is called again, or forget_due() is.
  void allow_s(std::uint64_t seconds) {
    constexpr TimeUs kUsPerSecond = 1'000'000;
    due_us_ = steady_now_us() + static_cast<TimeUs>(seconds) * kUsPerSecond;
  }
  void forget_due() { due_us_ = 0; }
  /// Closes the connection if its time is over. The gateway calls it about once a second.
  void close_if_due(TimeUs now_us) {
    if (due_us_ != 0 && now_us >= due_us_) close();
  }

 private:
  std::optional<Socket> plain_;  // one of the two
  std::optional<Tls> tls_;
  TimeUs due_us_ = 0;  // 0: never
};

/// Ends the connection below a WebSocket. Beast finds both functions by their arguments.
inline void teardown(boost::beast::role_type role, WebStream& stream,
                     boost::system::error_code& error) {
  if (stream.tls() != nullptr) {
    boost::beast::teardown(role, *stream.tls(), error);
  } else {
    boost::beast::websocket::teardown(role, stream.next_layer(), error);
  }
}
template <class Handler>
void async_teardown(boost::beast::role_type role, WebStream& stream, Handler&& handler) {
  if (stream.tls() != nullptr) {
    boost::beast::async_teardown(role, *stream.tls(), std::forward<Handler>(handler));
  } else {
    boost::beast::websocket::async_teardown(role, stream.next_layer(),
                                            std::forward<Handler>(handler));
  }
}

}  // namespace runstone
