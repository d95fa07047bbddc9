#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

using Clients = std::vector<std::unique_ptr<RawClient>>;

void connect(Clients& clients, std::uint16_t port, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    clients.push_back(std::make_unique<RawClient>(port));
    REQUIRE(clients.back()->is_open());
  }
}

/// Reads until the server ends the connection. Returns false if it did not within a second.
bool is_ended(RawClient& client) {
  while (client.is_open()) {
    if (!client.next(1'000)) break;
  }
  return !client.is_open();
}

TEST_CASE("silent sockets do not keep a player out: the oldest of them are closed",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.sessions_max = 2;
  config.handshakes_per_address = 1'000;
  const auto server = start_server(config, flat_creation());
  RawClient early(server->port());
  REQUIRE(early.join(1).has_value());
  Clients silent;
  connect(silent, server->port(), 2 + 64 + 10);
  RawClient late(server->port());
  REQUIRE(late.join(2).has_value());
  CHECK(is_ended(*silent.front()));
  CHECK(is_ended(*silent[10]));  // one player, 65 silent sockets and the new one were too many
  CHECK_FALSE(is_ended(*silent.back()));
  early.send(Ping{5});
  CHECK(early.next_of<Pong>().has_value());  // a player's connection is never closed
}

TEST_CASE("one address may have few connections in the handshake, and players do not count",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.handshakes_per_address = 3;
  const auto server = start_server(config, flat_creation());
  Clients players;
  for (std::uint8_t who = 1; who <= 5; ++who) {
    connect(players, server->port(), 1);
    REQUIRE(players.back()->join(who).has_value());
  }
  Clients silent;
  connect(silent, server->port(), 5);
  RawClient late(server->port());
  REQUIRE(late.join(9).has_value());
  for (std::size_t i = 0; i < 3; ++i) CHECK(is_ended(*silent[i]));
  CHECK_FALSE(is_ended(*silent.back()));
  for (const auto& player : players) {
    player->send(Ping{5});
    CHECK(player->next_of<Pong>().has_value());
  }
}

}  // namespace
}  // namespace runstone::test
