#include <sys/stat.h>

#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/read_until.hpp>
#include <asio/write.hpp>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "protocol/codec/proxy_header.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

using Local = asio::local::stream_protocol;

/// Sends a line to a Unix socket and returns the answer.
std::string ask(const std::string& path, const std::string& line) {
  asio::io_context io;
  Local::socket socket(io);
  socket.connect(Local::endpoint(path));
  asio::write(socket, asio::buffer(line + "\n"));
  std::string answer;
  asio::error_code error;
  do {
    asio::read_until(socket, asio::dynamic_buffer(answer), "\n=", error);
  } while (!error && answer.find("\n=") == std::string::npos);
  return answer;
}

TEST_CASE("the status socket answers one question and takes no command", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = server_config_of(folder);
  const auto server = start_server(config, flat_creation());
  const std::string path = config.gateway_socket + ".status";
  CHECK(ask(path, "status").find("|counters connections=") == 0);
  for (const char* line : {"stop", "players", "status now", "", "say hello"}) {
    CAPTURE(line);
    CHECK(ask(path, line).find("|the only question is `status`\n=") == 0);
  }
  CHECK(ask(path, "status").find("sessions=0") != std::string::npos);  // it still runs
}

TEST_CASE("the sockets for a gateway keep others out and go with the server", "[integration]") {
  const TempFolder folder;
  ServerConfig config = server_config_of(folder);
  const auto mode = [&](const std::string& path) {
    struct stat about{};
    return ::stat(path.c_str(), &about) == 0 ? about.st_mode & 0777 : 0;
  };
  for (const bool is_for_group : {false, true}) {
    config.gateway_group = is_for_group;
    const auto server = start_server(config, flat_creation());
    const mode_t expected = is_for_group ? 0660 : 0600;
    CHECK(mode(config.gateway_socket) == expected);
    CHECK(mode(config.gateway_socket + ".status") == expected);
  }
  CHECK_FALSE(std::filesystem::exists(config.gateway_socket));
  CHECK_FALSE(std::filesystem::exists(config.gateway_socket + ".status"));
}

TEST_CASE("a server that cannot make its gateway socket makes no world", "[integration]") {
  const TempFolder folder;
  ServerConfig config = server_config_of(folder);
  const auto error_of = [&](const std::string& path) {
    config.gateway_socket = path;
    const auto server = Server::start(config, flat_creation());
    return server ? std::string() : server.error();
  };
  CHECK(error_of(folder / std::string(120, 'x')).find("at most 107 bytes") != std::string::npos);
  std::ofstream(folder / "notes.txt") << "mine";
  CHECK(error_of(folder / "notes.txt").find("this is a file") != std::string::npos);
  {
    asio::io_context io;
    Local::acceptor other(io, Local::endpoint(folder / "other.sock"));
    CHECK(error_of(folder / "other.sock").find("another program listens") != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(config.world));
  CHECK(error_of(folder / "other.sock").empty());  // now nobody listens there
}

TEST_CASE("a PROXY header over TCP is no header, so no client chooses its address",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = server_config_of(folder);
  config.insecure = true;
  const auto server = start_server(config, flat_creation());
  RawClient client(server->port(), INADDR_LOOPBACK, RawClient::Encryption::none);
  client.send_bytes(write_proxy_header(peer_endpoint_v4(0xcb007107, 1), peer_endpoint_v4(1, 1)));
  const auto goodbye = client.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::malformed_frame);
}

}  // namespace
}  // namespace runstone::test
