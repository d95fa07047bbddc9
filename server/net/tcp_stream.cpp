#include "server/net/tcp_stream.hpp"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "server/net/tcp_room.hpp"

namespace runstone {
namespace {

constexpr TimeUs kAgainUsMin = 1'000, kAgainUsMax = 20'000;

}  // namespace

TcpStream::TcpStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form)
    : SocketStream(std::move(socket)) {
  asio::error_code ignored, gone;
  const auto client = this->socket().remote_endpoint(gone);
  asio::ip::tcp::endpoint end;
  if (!gone && client.size() <= end.capacity()) {
    std::memcpy(end.data(), client.data(), client.size());
    set_peer(end, log_form);
  }
  this->socket().set_option(asio::ip::tcp::no_delay(true), ignored);
  // Both options only make edits faster. The server works without them.
  const int lowat = static_cast<int>(notsent_bytes);
  (void)::setsockopt(this->socket().native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &lowat,
                     sizeof lowat);
}

StreamRoom TcpStream::room() {
  const TcpRoom room = tcp_room(socket().native_handle());
  return {room.bytes, std::clamp<TimeUs>(room.round_trip_us / 8, kAgainUsMin, kAgainUsMax)};
}

std::unique_ptr<ByteStream> make_tcp_stream(asio::ip::tcp::socket socket, std::size_t notsent_bytes,
                                            AddressForm log_form) {
  return std::make_unique<TcpStream>(std::move(socket), notsent_bytes, log_form);
}

}  // namespace runstone
