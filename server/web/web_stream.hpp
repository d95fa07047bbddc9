// WebStream: a TCP connection of a browser, with or without TLS, as a stream for Beast. Frames of
// the server are written past Beast, without waiting: write_now().
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <algorithm>
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/role.hpp>
#include <optional>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/os/steady_clock.hpp"
#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"

namespace runstone {

class WebStream {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using next_layer_type = Socket;
  using executor_type = Socket::executor_type;
  using ErrorCode = boost::system::error_code;
  /// One call of async_write_some() takes so many bytes at most. A frame of a WebSocket is always
  /// shorter, so it is never split by another one.
  static constexpr std::size_t kWriteBytesMax = 64 * 1024;

  /// `context`: null for a stream without TLS.
  WebStream(Socket socket, const TlsContext* context);
  WebStream(const WebStream&) = delete;
  WebStream& operator=(const WebStream&) = delete;

  executor_type get_executor() { return socket_.get_executor(); }
  Socket& next_layer() { return socket_; }
  const Socket& next_layer() const { return socket_; }
  /// Returns false after close(), and after Beast has closed a WebSocket that was silent for too
  /// long.
  bool has_socket() const { return socket_.is_open(); }

  /// Performs the TLS handshake, if the stream has TLS. Returns false if it failed.
  static boost::asio::awaitable<bool> handshake(WebStream& stream);
  /// Reads what has come. `error` is would_block if nothing has.
  std::size_t read_now(boost::asio::mutable_buffer into, ErrorCode& error);
  /// Queues bytes behind those that are unsent, and sends what the socket takes. Returns false if
  /// the connection has failed.
  bool write_now(ByteView bytes);
  /// Sends more of what is unsent. Returns false if the connection has failed.
  bool send_now();
  bool has_unsent() { return output().size() > sent_; }
  /// Tells the browser that nothing more will come.
  void end_sending();
  /// Closes the connection. Calls under way fail.
  void close();

  // These functions make the class a stream for Beast.
  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    boost::asio::mutable_buffer into;
    for (auto it = boost::asio::buffer_sequence_begin(buffers);
         it != boost::asio::buffer_sequence_end(buffers) && into.size() == 0; ++it)
      into = *it;
    return boost::asio::async_initiate<Token, void(ErrorCode, std::size_t)>(StartRead{this}, token,
                                                                            into);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(ErrorCode, std::size_t)>(StartWrite{this}, token,
                                                                            buffers);
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
  /// A read or a write that waits for the socket. `Self` has go(error), which returns false if it
  /// has to wait longer, and the number of bytes for the handler.
  template <class Self, class Handler>
  struct Waiting {
    Waiting(WebStream* of, Handler then) : stream(of), handler(std::move(then)) {}
    using executor_type = boost::asio::associated_executor_t<Handler, WebStream::executor_type>;
    executor_type get_executor() const {
      return boost::asio::get_associated_executor(handler, stream->get_executor());
    }
    Self& self() { return static_cast<Self&>(*this); }
    void wait() {
      Socket& socket = stream->next_layer();
      socket.async_wait(Self::kWait, std::move(self()));
    }
    void start() {
      ErrorCode error;
      if (!self().go(error)) return wait();
      // A handler must not be called before this function has returned.
      const executor_type executor = get_executor();
      boost::asio::post(executor,
                        boost::beast::bind_front_handler(std::move(handler), error, bytes));
    }
    void operator()(ErrorCode error) {
      if (!error && !self().go(error)) return wait();
      handler(error, error ? 0 : bytes);
    }
    WebStream* stream;
    Handler handler;
    std::size_t bytes = 0;
  };
  template <class Handler>
  struct Read : Waiting<Read<Handler>, Handler> {
    static constexpr auto kWait = Socket::wait_read;
    Read(WebStream* of, boost::asio::mutable_buffer room, Handler then)
        : Waiting<Read, Handler>(of, std::move(then)), into(room) {}
    bool go(ErrorCode& error) {
      if (into.size() == 0) return true;
      this->bytes = this->stream->read_now(into, error);
      return error != boost::asio::error::would_block;
    }
    boost::asio::mutable_buffer into;
  };
  template <class Handler>
  struct Write : Waiting<Write<Handler>, Handler> {
    static constexpr auto kWait = Socket::wait_write;
    Write(WebStream* of, std::size_t count, Handler then)
        : Waiting<Write, Handler>(of, std::move(then)) {
      this->bytes = count;
    }
    bool go(ErrorCode& error) {
      if (!this->stream->send_now()) error = boost::asio::error::broken_pipe;
      return error || !this->stream->has_unsent();
    }
  };
  struct StartRead {
    WebStream* stream;
    template <class Handler>
    void operator()(Handler&& handler, boost::asio::mutable_buffer into) const {
      Read<std::decay_t<Handler>>(stream, into, std::forward<Handler>(handler)).start();
    }
  };
  struct StartWrite {
    WebStream* stream;
    template <class Handler, class Buffers>
    void operator()(Handler&& handler, const Buffers& buffers) const {
      Bytes text(std::min(boost::asio::buffer_size(buffers), kWriteBytesMax));
      boost::asio::buffer_copy(boost::asio::buffer(text), buffers);
      // The operation notices if this fails.
      static_cast<void>(stream->write_now(text));
      Write<std::decay_t<Handler>>(stream, text.size(), std::forward<Handler>(handler)).start();
    }
  };
  Bytes& output() { return tls_ ? tls_->output() : plain_output_; }

  Socket socket_;
  SocketSource source_;
  std::optional<TlsChannel> tls_;  // nullopt: no TLS
  bool is_open_ = true;            // false after close() and after an error
  bool is_secure_ = false;         // the TLS handshake is complete
  Bytes plain_output_;             // unsent bytes of a stream without TLS
  std::size_t sent_ = 0;           // of output()
  TimeUs due_us_ = 0;              // 0: never
};

/// Ends the connection below a WebSocket. Beast finds both functions by their arguments.
inline void teardown(boost::beast::role_type /*role*/, WebStream& stream,
                     boost::system::error_code& error) {
  stream.end_sending();
  error = {};
}
template <class Handler>
void async_teardown(boost::beast::role_type /*role*/, WebStream& stream, Handler&& handler) {
  stream.end_sending();
  boost::asio::post(stream.get_executor(),
                    boost::beast::bind_front_handler(std::forward<Handler>(handler),
                                                     boost::system::error_code()));
}

}  // namespace runstone
