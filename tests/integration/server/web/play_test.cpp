#include <arpa/inet.h>

#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "tests/integration/server/app/session_messages.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/net/web_player.hpp"
#include "tests/support/tls/pem_files.hpp"

namespace runstone::test {
namespace {

constexpr std::uint32_t kOtherAddress = 0x7f000002, kThirdAddress = 0x7f000003;

View view_at_spawn() {
  View view;
  view.number = 1;
  view.radius_h = view.radius_v = 1;
  return view;
}

TEST_CASE("a player joins through the gateway, edits, and both sides see the commit",
          "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  WebPlayer browser(bench.port());
  REQUIRE(browser.is_open());
  REQUIRE(browser.join(1).has_value());
  RawClient desktop(bench.server->port());
  REQUIRE(desktop.join(2).has_value());
  browser.send(view_at_spawn());
  desktop.send(view_at_spawn());
  REQUIRE(browser.next_of<ViewState>().has_value());
  REQUIRE(desktop.next_of<ViewState>().has_value());
  browser.send(voxel_edit(1, {1, 2, 3}, 2));
  const auto seen = browser.next_of<Commit>();
  REQUIRE(seen.has_value());
  CHECK(seen->edits.size() == 1);
  CHECK(desktop.next_of<Commit>().has_value());
  desktop.send(voxel_edit(1, {2, 2, 3}, 2));
  CHECK(browser.next_of<Commit>().has_value());
}

TEST_CASE("a player joins over TLS with the certificate of the gateway", "[integration]") {
  const TempFolder folder;
  const PemFiles pem("localhost");
  WebConfig config = web_config_of(folder);
  config.tls_certificate = pem.chain_file();
  config.tls_key = pem.key_file();
  const WebBench bench(server_config_of(folder), config);
  WebPlayer browser(bench.port(), INADDR_LOOPBACK, true);
  REQUIRE(browser.is_open());
  REQUIRE(browser.join(1).has_value());
  browser.send(Ping{5});
  CHECK(browser.next_of<Pong>().has_value());
  WebPeer page(bench.port(), INADDR_LOOPBACK, true);
  CHECK(page.get("/").status == 200);
  WebPeer plain(bench.port());
  plain.send("GET / HTTP/1.1\r\nHost: x\r\n\r\n");
  CHECK(plain.sees_the_end());
}

TEST_CASE("terrain in messages of many frames passes, in messages of whole frames",
          "[integration]") {
  const TempFolder folder;
  WorldCreation hills;
  hills.generator = "terrain";
  hills.seed = 1;
  hills.edge = 128;
  const auto server = start_server(server_config_of(folder), hills);
  const auto gateway = start_gateway(web_config_of(folder));
  WebPlayer browser(gateway->port());
  REQUIRE(browser.join(1).has_value());
  View wide = view_at_spawn();
  wide.radius_h = wide.radius_v = 1;
  browser.send(wide);
  for (;;) {
    const auto state = browser.next_of<ViewState>();
    REQUIRE(state.has_value());
    if (state->phase == ViewPhase::complete) break;
  }
  CHECK(browser.frames_read() > browser.messages_read());
}

TEST_CASE("the limits of an address hold for players behind the gateway", "[integration]") {
  const TempFolder folder;
  ServerConfig config = server_config_of(folder);
  config.sessions_per_address = 2;
  const WebBench bench(config, web_config_of(folder));
  std::vector<std::unique_ptr<WebPlayer>> players;
  const auto joins = [&](std::uint32_t from) {
    players.push_back(std::make_unique<WebPlayer>(bench.port(), from));
    REQUIRE(players.back()->is_open());
    return players.back()->join(static_cast<std::uint8_t>(players.size())).has_value();
  };
  CHECK(joins(kOtherAddress));
  CHECK(joins(kOtherAddress));
  CHECK_FALSE(joins(kOtherAddress));
  CHECK_FALSE(players.back()->refusal.empty());
  CHECK(joins(kThirdAddress));
  // The same address counts at the server's own port, too.
  RawClient desktop(bench.server->port(), kOtherAddress);
  CHECK_FALSE(desktop.join(9).has_value());
}

TEST_CASE("after a goodbye of the server the WebSocket is closed in order", "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  WebPlayer browser(bench.port());
  Hello old;
  old.protocol = 1;
  old.name = "ana";
  old.encodings = 1;
  browser.send(old);
  CHECK_FALSE(browser.next_of<Welcome>().has_value());
  CHECK_FALSE(browser.refusal.empty());
  REQUIRE(browser.closed.has_value());
  CHECK(browser.closed->close_code() == 1000);
  CHECK(browser.closed->close_words() == "the server has ended the session");
}

TEST_CASE("a browser that leaves without a word leaves the world", "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  {
    WebPlayer browser(bench.port());
    REQUIRE(browser.join(1).has_value());
  }
  CHECK(comes_to_show(bench.port(), "/", "Nobody is in this world now."));
}

}  // namespace
}  // namespace runstone::test
