#include "server/net/socket_stream.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "common/os/thread_cpu_ns.hpp"
#include "server/net/address_block_of.hpp"
#include "server/net/await_tuple.hpp"
#include "server/net/peer_text.hpp"

namespace runstone {

SocketStream::SocketStream(asio::generic::stream_protocol::socket socket)
    : socket_(std::move(socket)) {
  asio::error_code ignored;
  socket_.non_blocking(true, ignored);
}

void SocketStream::set_peer(const asio::ip::tcp::endpoint& client, AddressForm log_form) {
  peer_ = peer_text(client, log_form);
  address_ = address_block(client.address());
}

asio::awaitable<StreamStart> SocketStream::open() { co_return StreamStart::open; }

asio::awaitable<IoResult> SocketStream::read_some(asio::mutable_buffer into) {
  const auto [error, bytes] = co_await socket_.async_read_some(into, kTuple);
  co_return IoResult{error, bytes, bytes};
}

asio::awaitable<IoResult> SocketStream::write(const std::vector<asio::const_buffer>& buffers,
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
      const auto [error] = co_await socket_.async_wait(asio::socket_base::wait_write, kTuple);
      result.error = error;
    }
    if (result.error) break;
  }
  co_return result;
}

void SocketStream::shutdown_send() {
  asio::error_code ignored;
  socket_.shutdown(asio::socket_base::shutdown_send, ignored);
}

void SocketStream::close() {
  asio::error_code ignored;
  socket_.close(ignored);
}

}  // namespace runstone
