#include "server/admin/server_address.hpp"

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <string>

using namespace runstone;

namespace {

std::string peer_address(const std::string& setting, const std::string& listen) {
  ServerConfig config;
  REQUIRE(set_config(config, "peer_address", setting).has_value());
  REQUIRE(set_config(config, "listen", listen).has_value());
  return peer_address_of(config, 5000);
}

std::string player_address(const std::string& setting) {
  ServerConfig config;
  REQUIRE(set_config(config, "player_address", setting).has_value());
  return player_address_of(config, 5000);
}

}  // namespace

TEST_CASE("the setting peer_address gets the server's port if it has none", "[config]") {
  const std::string listen = "192.0.2.1:4000";
  CHECK(peer_address("one.example", listen) == "one.example:5000");
  CHECK(peer_address("one.example:6000", listen) == "one.example:6000");
  CHECK(peer_address("192.0.2.7", listen) == "192.0.2.7:5000");
  CHECK(peer_address("2001:db8::7", listen) == "[2001:db8::7]:5000");
  CHECK(peer_address("[2001:db8::7]", listen) == "[2001:db8::7]:5000");
  CHECK(peer_address("[2001:db8::7]:6000", listen) == "[2001:db8::7]:6000");
}

TEST_CASE("without peer_address the address is that of listen, if it is a single one", "[config]") {
  CHECK(peer_address("", "192.0.2.1:4000") == "192.0.2.1:5000");
  CHECK(peer_address("", "192.0.2.1:0") == "192.0.2.1:5000");
  CHECK(peer_address("", "one.example") == "one.example:5000");
  CHECK(peer_address("", "[::1]:4000") == "[::1]:5000");
  CHECK(peer_address("", "2001:db8::7") == "[2001:db8::7]:5000");
}

TEST_CASE("a server that listens at every address is reached by the machine's name", "[config]") {
  std::array<char, 256> name{};
  REQUIRE(::gethostname(name.data(), name.size() - 1) == 0);
  const std::string expected = std::string(name.data()) + ":5000";
  for (const char* listen :
       {"0.0.0.0:4000", "0.0.0.0", ":4000", "[::]:4000", "::", "[0::0]:0", "*:4000", "*"}) {
    CAPTURE(listen);
    CHECK(peer_address("", listen) == expected);
  }
}

TEST_CASE("a peer_address that is no address is an error", "[config]") {
  ServerConfig config;
  for (const char* bad : {":5000", "one.example:", "one.example:0", "one.example:65536",
                          "one.example:x", "[one.example]", "[::1"}) {
    CAPTURE(bad);
    const auto set = set_config(config, "peer_address", bad);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().find("peer_address") != std::string::npos);
    CHECK(config.peer_address.empty());
  }
}

TEST_CASE("the setting player_address gets the server's port if it has none", "[config]") {
  CHECK(player_address("play.example") == "play.example:5000");
  CHECK(player_address("play.example:6000") == "play.example:6000");
  CHECK(player_address("2001:db8::7") == "[2001:db8::7]:5000");
  CHECK(player_address("[2001:db8::7]:6000") == "[2001:db8::7]:6000");
}

TEST_CASE("without player_address, players are not told of the server", "[config]") {
  // The other servers may reach it at an address that players do not reach.
  CHECK(player_address("").empty());
  ServerConfig config;
  REQUIRE(set_config(config, "peer_address", "inside.example:7000").has_value());
  CHECK(player_address_of(config, 5000).empty());
}

TEST_CASE("an address of the web is no address of a server, and the error says what to write",
          "[config]") {
  for (const char* setting : {"public_address", "player_address", "peer_address"}) {
    CAPTURE(setting);
    ServerConfig config;
    for (const char* bad :
         {"https://play.example.org/", "http://play.example.org", "runstone://play.example.org/#x",
          "play.example.org/", "play.example.org/client", "play.example.org?x"}) {
      CAPTURE(bad);
      const auto set = set_config(config, setting, bad);
      REQUIRE_FALSE(set.has_value());
      CHECK(set.error().find("; write play.example.org") != std::string::npos);
    }
    for (const char* bad : {"play example.org", " play.example.org", "play.example.org\n", ":4747",
                            "play.example.org:x", "play.example.org:0", "https://", "//x"}) {
      CAPTURE(bad);
      CHECK_FALSE(set_config(config, setting, bad).has_value());
    }
    CHECK(config == ServerConfig{});
    for (const char* good : {"play.example.org", "play.example.org:443", "192.0.2.7", "2001:db8::7",
                             "[2001:db8::7]:443", "xn--hst-sna.example", ""}) {
      CAPTURE(good);
      CHECK(set_config(config, setting, good).has_value());
    }
  }
}

TEST_CASE("a player_address or page_address of a wrong form is an error", "[config]") {
  ServerConfig config;
  for (const char* bad : {":5000", "one.example:", "one.example:0", "one.example:65536",
                          "h\xc3\xb6st.example", "fe80::1%eth0", "https://one.example"}) {
    CAPTURE(bad);
    const auto set = set_config(config, "player_address", bad);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().find("player_address") != std::string::npos);
  }
  for (const char* bad :
       {"one.example", "https://", "https://one.example/?x", "wss://one.example"}) {
    CAPTURE(bad);
    const auto set = set_config(config, "page_address", bad);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().find("page_address") != std::string::npos);
  }
  CHECK(config == ServerConfig{});
  CHECK(set_config(config, "page_address", "https://one.example/world/valley/").has_value());
  CHECK(config.page_address == "https://one.example/world/valley/");
}
