#include "server/web/page_link.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <memory>

namespace runstone {
namespace {

// A picture of 4 MiB in hex.
constexpr std::size_t kPageReplyBytesMax = std::size_t{9} << 20;

}  // namespace

boost::asio::awaitable<PageReply> ask_page(boost::asio::io_context& io, std::string path,
                                           std::string line) {
  namespace net = boost::asio;
  const auto socket = std::make_shared<net::local::stream_protocol::socket>(io);
  net::steady_timer deadline(io, std::chrono::seconds(kPageAnswerSeconds));
  deadline.async_wait([socket](const boost::system::error_code& cancelled) {
    boost::system::error_code ignored;
    if (!cancelled) socket->close(ignored);
  });
  boost::system::error_code error;
  const net::local::stream_protocol::endpoint server(path);
  co_await socket->async_connect(server, net::redirect_error(net::use_awaitable, error));
  line += '\n';
  if (!error) {
    co_await net::async_write(*socket, net::buffer(line),
                              net::redirect_error(net::use_awaitable, error));
  }
  std::string answer;
  std::array<char, 4096> more{};
  while (!error && !is_whole_page_reply(answer) && answer.size() < kPageReplyBytesMax) {
    const std::size_t got = co_await socket->async_read_some(
        net::buffer(more), net::redirect_error(net::use_awaitable, error));
    answer.append(more.data(), got);
  }
  deadline.cancel();
  co_return parse_page_reply(answer);
}

}  // namespace runstone
