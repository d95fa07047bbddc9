// TcpStream: a ByteStream over a TCP socket.
#pragma once
#include <asio/ip/tcp.hpp>

#include "server/net/socket_stream.hpp"

namespace runstone {

class TcpStream final : public SocketStream {
 public:
  /// See make_tcp_stream().
  TcpStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form);

  StreamRoom room() override;
};

}  // namespace runstone
