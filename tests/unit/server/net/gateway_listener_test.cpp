#include "server/net/gateway_listener.hpp"

#include <sys/stat.h>

#include <asio/buffer.hpp>
#include <asio/write.hpp>
#include <catch2/catch.hpp>
#include <fstream>
#include <memory>
#include <vector>

#include "protocol/codec/proxy_header.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::test;
using Local = asio::local::stream_protocol;

namespace {

/// A listener whose thread works only when the test lets it.
struct GatewayBench {
  explicit GatewayBench(std::chrono::milliseconds header_time = std::chrono::minutes(5)) {
    listener = std::make_shared<GatewayListener>(
        io, header_time, [this](Local::socket socket, const asio::ip::tcp::endpoint& client) {
          clients.push_back(client);
          sockets.push_back(std::move(socket));
        });
    REQUIRE(listener->listen(path(), false).has_value());
    listener->start();
  }
  ~GatewayBench() {
    listener->stop();
    io.restart();
    io.run_for(std::chrono::milliseconds(10));
  }
  std::string path() const { return folder / "web.sock"; }
  void work() {
    for (int i = 0; i < 20; ++i) {
      io.restart();
      io.poll();
    }
  }
  Local::socket connect() {
    Local::socket out(peers);
    out.connect(Local::endpoint(path()));
    work();
    return out;
  }
  void send(Local::socket& to, const Bytes& bytes) {
    asio::write(to, asio::buffer(bytes));
    work();
  }
  /// Returns true if the listener has closed the connection.
  static bool is_closed(Local::socket& socket) {
    socket.non_blocking(true);
    std::uint8_t byte = 0;
    asio::error_code error;
    socket.read_some(asio::buffer(&byte, 1), error);
    return error && error != asio::error::would_block;
  }
  TempFolder folder;
  asio::io_context io, peers;
  std::shared_ptr<GatewayListener> listener;
  std::vector<asio::ip::tcp::endpoint> clients;
  std::vector<Local::socket> sockets;
};

Bytes header_of(std::uint32_t address) {
  return write_proxy_header(peer_endpoint_v4(address, 40312), peer_endpoint_v4(0x7f000001, 443));
}

}  // namespace

TEST_CASE("a connection of the gateway is passed on with the address of its header", "[net]") {
  GatewayBench bench;
  Local::socket gateway = bench.connect();
  Bytes bytes = header_of(0xcb007107);
  bytes.push_back(42);  // the first byte of the client
  for (const std::uint8_t byte : bytes) bench.send(gateway, {byte});
  REQUIRE(bench.clients.size() == 1);
  CHECK(bench.clients[0].address().to_v6().is_v4_mapped());
  CHECK(bench.clients[0].address().to_string() == "::ffff:203.0.113.7");
  CHECK(bench.clients[0].port() == 40312);
  std::uint8_t first = 0;
  bench.sockets[0].read_some(asio::buffer(&first, 1));
  CHECK(first == 42);  // nothing behind the header was read
}

TEST_CASE("a connection of the gateway itself counts as one of this machine", "[net]") {
  GatewayBench bench;
  Local::socket gateway = bench.connect();
  Bytes local = header_of(0);
  local[12] = 0x20;
  bench.send(gateway, local);
  REQUIRE(bench.clients.size() == 1);
  CHECK(bench.clients[0].address().to_string() == "::ffff:127.0.0.1");
}

TEST_CASE("a connection that begins with something else than a PROXY header is closed", "[net]") {
  GatewayBench bench;
  Bytes oversized = header_of(1);
  oversized[14] = 0xff;
  Bytes of_unix = header_of(1);
  of_unix[13] = 0x31;
  const std::string line = "PROXY TCP4 203.0.113.7 192.0.2.1 40312 443\r\n";
  for (const Bytes& bytes : {oversized, of_unix, Bytes(line.begin(), line.end()), Bytes(64)}) {
    Local::socket gateway = bench.connect();
    bench.send(gateway, bytes);
    CHECK(GatewayBench::is_closed(gateway));
  }
  CHECK(bench.clients.empty());
}

TEST_CASE("a connection without a header is closed after its time", "[net]") {
  GatewayBench bench(std::chrono::milliseconds(1));
  Local::socket gateway = bench.connect();
  Bytes cut = header_of(1);
  cut.pop_back();
  asio::error_code broken;
  asio::write(gateway, asio::buffer(cut), broken);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  bool is_closed = false;
  while (!is_closed && std::chrono::steady_clock::now() < end) {
    bench.io.restart();
    bench.io.run_for(std::chrono::milliseconds(50));
    is_closed = GatewayBench::is_closed(gateway);
  }
  CHECK(is_closed);
  CHECK(bench.clients.empty());
}

TEST_CASE("connections that send no header cannot pile up", "[net]") {
  GatewayBench bench;
  std::vector<Local::socket> silent;
  for (int i = 0; i < 256; ++i) silent.push_back(bench.connect());
  Local::socket one_more = bench.connect();
  CHECK(GatewayBench::is_closed(one_more));
  CHECK_FALSE(GatewayBench::is_closed(silent.front()));
  silent.clear();
  bench.work();
  Local::socket gateway = bench.connect();
  bench.send(gateway, header_of(7));
  CHECK(bench.clients.size() == 1);
}

TEST_CASE("a stop waits for no connection without a header", "[net]") {
  GatewayBench bench;  // its header may take five minutes
  const Local::socket silent = bench.connect();
  bench.listener->stop();
  bench.io.restart();
  bench.io.run();  // it returns when no connection waits any more
  CHECK(bench.clients.empty());
}

TEST_CASE("the file of the gateway's socket keeps other users out and is removed", "[net]") {
  TempFolder folder;
  const std::string path = folder / "web.sock";
  for (const bool is_for_group : {false, true}) {
    asio::io_context io;
    auto listener = std::make_shared<GatewayListener>(io, std::chrono::seconds(1),
                                                      [](Local::socket, const auto&) {});
    REQUIRE(listener->listen(path, is_for_group).has_value());
    struct stat about{};
    REQUIRE(::stat(path.c_str(), &about) == 0);
    CHECK((about.st_mode & 0777) == (is_for_group ? 0660U : 0600U));
    listener->start();
    listener->stop();
    io.run();
    CHECK(::stat(path.c_str(), &about) != 0);
  }
}

TEST_CASE("a socket's file is replaced only if nobody listens there", "[net]") {
  TempFolder folder;
  const std::string path = folder / "web.sock";
  asio::io_context io;
  {
    // A server that crashed leaves its file.
    Local::acceptor crashed(io, Local::endpoint(path));
    CHECK_FALSE(can_listen_at_path(path).has_value());
  }
  CHECK(can_listen_at_path(path).has_value());
  CHECK_FALSE(can_listen_at_path(folder / std::string(120, 'x')).has_value());
  std::ofstream(folder / "notes.txt") << "mine";
  CHECK_FALSE(can_listen_at_path(folder / "notes.txt").has_value());
}
