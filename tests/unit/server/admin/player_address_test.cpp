#include "server/admin/player_address.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace runstone;

namespace {

std::string player_address(const std::string& setting) {
  ServerConfig config;
  REQUIRE(set_config(config, "player_address", setting).has_value());
  return player_address_of(config, 5000);
}

}  // namespace

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
