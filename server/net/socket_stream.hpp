// SocketStream: the part of a ByteStream that TCP and Unix sockets share.
#pragma once
#include <asio/generic/stream_protocol.hpp>
#include <span>
#include <string>
#include <vector>

#include "server/net/byte_stream.hpp"

namespace runstone {

class SocketStream : public ByteStream {
 public:
  /// Makes the socket non-blocking.
  explicit SocketStream(asio::generic::stream_protocol::socket socket);

  asio::awaitable<StreamStart> open() override;
  asio::awaitable<IoResult> read_some(asio::mutable_buffer into) override;
  IoResult write_now(std::span<const asio::const_buffer> buffers,
                     std::size_t terrain_bytes) override;
  asio::awaitable<IoResult> write_rest() override;
  void shutdown_send() override;
  void close() override;
  std::string peer() const override { return peer_; }
  AddressBlock address() const override { return address_; }

  /// Non-blocking.
  asio::generic::stream_protocol::socket& socket() { return socket_; }

 protected:
  /// Sets what peer() and address() return from the endpoint of the client.
  void set_peer(const asio::ip::tcp::endpoint& client, AddressForm log_form);

 private:
  asio::generic::stream_protocol::socket socket_;
  std::vector<asio::const_buffer> rest_;  // of the write under way
  std::string peer_ = "?";
  AddressBlock address_{};
};

}  // namespace runstone
