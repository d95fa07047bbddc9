#include "server/net/tcp_room.hpp"

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

using namespace runstone;
using asio::ip::tcp;

namespace {

struct Connection {
  Connection() {
    tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
    client.connect(acceptor.local_endpoint());
    server = acceptor.accept();
    server.non_blocking(true);
    client.non_blocking(true);
  }
  /// Writes until the kernel accepts no more.
  void fill() {
    const std::vector<std::uint8_t> bytes(1 << 16);
    asio::error_code error;
    while (!error) server.write_some(asio::buffer(bytes), error);
    REQUIRE(error == asio::error::would_block);
  }
  /// Reads everything that was sent, from the buffers of both ends.
  void drain() {
    std::vector<std::uint8_t> bytes(1 << 16);
    asio::error_code error;
    for (int idle = 0; idle < 1'000 && tcp_room(server.native_handle()).bytes == 0;) {
      client.read_some(asio::buffer(bytes), error);
      idle = error ? idle + 1 : 0;
      if (error) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  asio::io_context io;
  tcp::socket client{io}, server{io};
};

}  // namespace

TEST_CASE("a connection's first window has room, and none when more bytes wait than fit", "[net]") {
  Connection connection;
  const int socket = connection.server.native_handle();
  const std::size_t first = tcp_room(socket).bytes;
  CHECK(first >= 4 * 536);  // packets of the smallest size there is
  CHECK(first < SIZE_MAX);
  connection.fill();
  CHECK(tcp_room(socket).bytes == 0);
  connection.drain();
  CHECK(tcp_room(socket).bytes > 0);
  CHECK(tcp_room(socket).round_trip_us > 0);
}

TEST_CASE("a socket that is not TCP has unlimited room", "[net]") {
  CHECK(tcp_room(-1).bytes == SIZE_MAX);
}
