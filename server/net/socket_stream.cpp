#include "server/net/socket_stream.hpp"

#include <algorithm>
#include <asio/write.hpp>
#include <span>
#include <utility>

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

IoResult SocketStream::write_now(std::span<const asio::const_buffer> buffers,
                                 std::size_t /*terrain_bytes*/) {
  // asio::async_write would allocate and start a coroutine, and nearly all writes need not wait.
  IoResult result;
  result.bytes = socket_.write_some(buffers, result.error);
  if (result.error == asio::error::would_block) result.error = {};
  if (result.error) return result;
  std::size_t left = result.bytes;
  rest_.clear();
  for (const asio::const_buffer& buffer : buffers) {
    const std::size_t taken = std::min(left, buffer.size());
    left -= taken;
    if (taken < buffer.size()) rest_.push_back(buffer + taken);
  }
  result.has_rest = !rest_.empty();
  return result;
}

asio::awaitable<IoResult> SocketStream::write_rest() {
  IoResult result;
  const std::span<const asio::const_buffer> rest(rest_);
  const auto [error, bytes] = co_await asio::async_write(socket_, rest, kTuple);
  result.error = error;
  result.bytes = bytes;
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
