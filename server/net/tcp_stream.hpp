// TcpStream: a ByteStream over a TCP socket.
#pragma once
#include <asio/ip/tcp.hpp>
#include <string>
#include <vector>

#include "server/net/byte_stream.hpp"

namespace runstone {

class TcpStream final : public ByteStream {
 public:
  /// See make_tcp_stream().
  TcpStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form);

  asio::awaitable<StreamStart> open() override;
  asio::awaitable<IoResult> read_some(asio::mutable_buffer into) override;
  asio::awaitable<IoResult> write(const std::vector<asio::const_buffer>& buffers,
                                  std::size_t terrain_bytes) override;
  StreamRoom room() override;
  void shutdown_send() override;
  void close() override;
  std::string peer() const override { return peer_; }
  AddressBlock address() const override { return address_; }

  /// Non-blocking.
  asio::ip::tcp::socket& socket() { return socket_; }

 private:
  asio::ip::tcp::socket socket_;
  std::vector<asio::const_buffer> rest_;  // of the write under way
  std::string peer_ = "?";
  AddressBlock address_{};
};

}  // namespace runstone
