#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/server/web/fake_server.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/net/web_player.hpp"

namespace runstone::test {
namespace {

bool shows(const HttpReply& reply, const std::string& text) {
  return reply.body.find(text) != std::string::npos;
}

/// Two servers behind one gateway.
struct TwoServers {
  explicit TwoServers(const TempFolder& folder) {
    WebConfig config = web_config_of(folder);
    config.gateway_socket = WebConfig().gateway_socket;
    config.title = "Our worlds";
    for (const std::string name : {"valley", "hills"}) {
      ServerConfig server = quiet_config(folder / name);
      server.gateway_socket = folder / (name + ".sock");
      config.servers.push_back({name, server.gateway_socket, "", "", ""});
      servers.push_back(start_server(server, flat_creation()));
    }
    gateway = start_gateway(config);
  }
  std::uint16_t port() const { return gateway->port(); }
  std::vector<std::unique_ptr<Server>> servers;
  std::unique_ptr<WebGateway> gateway;
};

TEST_CASE("the path chooses one of several servers", "[integration]") {
  const TempFolder folder;
  TwoServers both(folder);
  WebPlayer one(both.port(), INADDR_LOOPBACK, false, "/world/valley/play");
  WebPlayer two(both.port(), INADDR_LOOPBACK, false, "/world/hills/play");
  REQUIRE(one.is_open());
  REQUIRE(two.is_open());
  REQUIRE(one.join(1).has_value());
  REQUIRE(two.join(2).has_value());
  REQUIRE(comes_to_show(both.port(), "/world/valley/", "<li>player1</li>"));
  REQUIRE(comes_to_show(both.port(), "/world/hills/", "<li>player2</li>"));
  WebPeer peer(both.port());
  CHECK_FALSE(shows(peer.get("/world/hills/"), "player1"));
  CHECK(shows(peer.get("/"), "<a href=\"world/valley/\">valley</a>: 1 player"));
  CHECK(shows(peer.get("/metrics"), "\nrunstone_sessions{world=\"hills\"} 1\n"));
  CHECK(shows(peer.get("/status"), "This gateway"));
  CHECK(shows(peer.get("/world/valley/status"), "<th scope=\"row\">sessions now</th><td>1</td>"));
  CHECK(peer.get("/world/valley").header("Location") == "valley/");
  CHECK(peer.get("/world/valley/style.css").status == 200);
  for (const char* target : {"/world/", "/world/none/", "/world/valley/../hills/", "/play",
                             "/world/valley/play/x", "/world/valleys/"}) {
    CAPTURE(target);
    CHECK(peer.get(target).status == 404);
  }
}

TEST_CASE("a WebSocket of several servers is opened in the folder of a world only",
          "[integration]") {
  const TempFolder folder;
  TwoServers both(folder);
  const auto status = [&](const std::string& target, const std::string& more = "") {
    WebPeer peer(both.port());
    return peer.upgrade(target, more).status;
  };
  CHECK(status("/world/valley/play") == 101);
  CHECK(status("/play") == 404);
  CHECK(status("/world/none/play") == 404);
  CHECK(status("/world/valley/") == 404);
  CHECK(status("/world/valley/play", "Origin: http://evil.example\r\n") == 403);
}

TEST_CASE("one server that stops leaves the other one's players alone", "[integration]") {
  const TempFolder folder;
  TwoServers both(folder);
  WebPlayer one(both.port(), INADDR_LOOPBACK, false, "/world/valley/play");
  REQUIRE(one.join(1).has_value());
  both.servers[1].reset();
  CHECK(comes_to_show(both.port(), "/", "hills</a>: not running now"));
  WebPeer away(both.port());
  REQUIRE(away.upgrade("/world/hills/play").status == 101);
  const auto closed = away.next_close();
  REQUIRE(closed.has_value());
  CHECK(closed->close_code() == 1013);
  one.send(Ping{5});
  CHECK(one.next_of<Pong>().has_value());
}

TEST_CASE("servers that do not answer delay no other page, and their own only once",
          "[integration]") {
  const TempFolder folder;
  ServerConfig valley = quiet_config(folder / "valley");
  valley.gateway_socket = folder / "valley.sock";
  const auto server = start_server(valley, flat_creation());
  WebConfig config = web_config_of(folder);
  config.gateway_socket = WebConfig().gateway_socket;
  config.servers.push_back({"valley", valley.gateway_socket, "", "", ""});
  std::vector<std::unique_ptr<FakeServer>> hung;
  for (const std::string name : {"a", "b", "c"}) {
    const std::string socket = folder / (name + ".sock");
    config.servers.push_back({name, socket, "", "", ""});
    hung.push_back(std::make_unique<FakeServer>(socket + ".status"));
  }
  const auto gateway = start_gateway(config);
  const auto begin = std::chrono::steady_clock::now();
  WebPeer all(gateway->port()), one(gateway->port());
  all.send("GET /status HTTP/1.1\r\nHost: x\r\n\r\n");
  CHECK(shows(one.get("/world/valley/status"), "The server is running."));
  CHECK(one.get("/style.css").status == 200);
  CHECK_FALSE(wait_input(all.native_handle(), 0));  // it still waits for the others
  const HttpReply page = all.reply();
  CHECK(shows(page, "valley</a></th><td>running"));
  CHECK(shows(page, "a</a></th><td>not running"));
  // The gateway waits two seconds for a status.
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(5));
}

TEST_CASE("the limits of an address hold for all worlds together", "[integration]") {
  const TempFolder folder;
  WebConfig config = web_config_of(folder);
  config.gateway_socket = WebConfig().gateway_socket;
  config.sockets_per_address = 2;
  config.servers = {{"a", folder / "a.sock", "", "", ""}, {"b", folder / "b.sock", "", "", ""}};
  const auto gateway = start_gateway(config);
  WebPeer one(gateway->port()), two(gateway->port());
  CHECK(one.get("/world/a/").status == 200);
  CHECK(two.get("/world/b/").status == 200);
  WebPeer three(gateway->port());
  CHECK(three.sees_the_end());
}

}  // namespace
}  // namespace runstone::test
