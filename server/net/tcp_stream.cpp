#include <netinet/tcp.h>
#include <sys/socket.h>

#include <asio/experimental/as_tuple.hpp>
#include <asio/use_awaitable.hpp>
#include <asio/write.hpp>
#include <utility>

#include "server/net/byte_stream.hpp"

namespace runstone {
namespace {

constexpr auto kTuple = asio::experimental::as_tuple(asio::use_awaitable);

class TcpStream : public ByteStream {
 public:
  TcpStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes) : socket_(std::move(socket)) {
    asio::error_code ignored;
    const auto end = socket_.remote_endpoint(ignored);
    if (!ignored) {
      const bool v6 = end.address().is_v6();
      peer_ = (v6 ? "[" : "") + end.address().to_string() + (v6 ? "]:" : ":") + std::to_string(end.port());
    }
    socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
    // Both options only make edits faster: a kernel without them still serves.
    const int lowat = static_cast<int>(notsent_bytes);
    (void)::setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &lowat, sizeof lowat);
  }

  asio::awaitable<IoResult> read_some(asio::mutable_buffer into) override {
    const auto [error, bytes] = co_await socket_.async_read_some(into, kTuple);
    co_return IoResult{error, bytes};
  }
  asio::awaitable<IoResult> write(const std::vector<asio::const_buffer>& buffers) override {
    const auto [error, bytes] = co_await asio::async_write(socket_, buffers, kTuple);
    co_return IoResult{error, bytes};
  }
  void shutdown_send() override {
    asio::error_code ignored;
    socket_.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
  }
  void close() override {
    asio::error_code ignored;
    socket_.close(ignored);
  }
  std::string peer() const override { return peer_; }

 private:
  asio::ip::tcp::socket socket_;
  std::string peer_ = "?";
};

}  // namespace

std::unique_ptr<ByteStream> make_tcp_stream(asio::ip::tcp::socket socket, std::size_t notsent_bytes) {
  return std::make_unique<TcpStream>(std::move(socket), notsent_bytes);
}

}  // namespace runstone
