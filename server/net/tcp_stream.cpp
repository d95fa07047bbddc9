#include "server/net/tcp_stream.hpp"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <span>
#include <utility>

#include "common/os/thread_cpu_ns.hpp"
#include "server/net/address_block_of.hpp"
#include "server/net/await_tuple.hpp"
#include "server/net/peer_text.hpp"
#include "server/net/tcp_room.hpp"

namespace runstone {
namespace {

constexpr TimeUs kAgainUsMin = 1'000, kAgainUsMax = 20'000;

}  // namespace

TcpStream::TcpStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form)
    : socket_(std::move(socket)) {
  asio::error_code ignored;
  const auto end = socket_.remote_endpoint(ignored);
  if (!ignored) {
    peer_ = peer_text(end, log_form);
    address_ = address_block(end.address());
  }
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  // Both options only make edits faster. The server works without them.
  const int lowat = static_cast<int>(notsent_bytes);
  (void)::setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &lowat, sizeof lowat);
  socket_.non_blocking(true, ignored);
}

asio::awaitable<StreamStart> TcpStream::open() { co_return StreamStart::open; }

asio::awaitable<IoResult> TcpStream::read_some(asio::mutable_buffer into) {
  const auto [error, bytes] = co_await socket_.async_read_some(into, kTuple);
  co_return IoResult{error, bytes, bytes};
}

asio::awaitable<IoResult> TcpStream::write(const std::vector<asio::const_buffer>& buffers,
                                           std::size_t /*terrain_bytes*/) {
  // This is not asio::async_write, because the cost of each call is measured, and most calls need
  // not wait.
  IoResult result;
  rest_ = buffers;
  std::size_t first = 0;  // the first buffer of rest_ that is not written completely
  while (first < rest_.size()) {
    const std::int64_t began_ns = thread_cpu_ns();
    const std::size_t written =
        socket_.write_some(std::span<const asio::const_buffer>(rest_).subspan(first), result.error);
    result.call_ns += thread_cpu_ns() - began_ns;
    result.bytes += written;
    for (std::size_t left = written; first < rest_.size();) {
      const std::size_t taken = std::min(left, rest_[first].size());
      rest_[first] += taken;
      left -= taken;
      if (rest_[first].size() != 0) break;
      ++first;
    }
    if (result.error == asio::error::would_block) {
      const auto [error] = co_await socket_.async_wait(asio::ip::tcp::socket::wait_write, kTuple);
      result.error = error;
    }
    if (result.error) break;
  }
  co_return result;
}

StreamRoom TcpStream::room() {
  const TcpRoom room = tcp_room(socket_.native_handle());
  return {room.bytes, std::clamp<TimeUs>(room.round_trip_us / 8, kAgainUsMin, kAgainUsMax)};
}

void TcpStream::shutdown_send() {
  asio::error_code ignored;
  socket_.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

void TcpStream::close() {
  asio::error_code ignored;
  socket_.close(ignored);
}

std::unique_ptr<ByteStream> make_tcp_stream(asio::ip::tcp::socket socket, std::size_t notsent_bytes,
                                            AddressForm log_form) {
  return std::make_unique<TcpStream>(std::move(socket), notsent_bytes, log_form);
}

}  // namespace runstone
