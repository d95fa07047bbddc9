// Names that keys own, with a real server: refusals, a crash after the first join, commands.
#include <catch2/catch.hpp>
#include <future>
#include <string>
#include <vector>

#include "protocol/codec/key_fingerprint.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

/// A client that keeps its key.
struct NamedClient : RawClient {
  NamedClient(std::uint16_t port, const std::string& name_) : RawClient(port) {
    name = name_;
    features = kFeatureNames;
  }
  /// Joins and returns the text of the refusal, or an empty text if it is accepted.
  std::string refusal(std::uint8_t who) {
    send(hello(who));
    while (const auto message = next()) {
      if (const auto* goodbye = std::get_if<Goodbye>(&*message)) {
        CHECK(goodbye->reason == GoodbyeReason::name_refused);
        return goodbye->text;
      }
      if (std::holds_alternative<Welcome>(*message)) return "";
    }
    return "the connection ended";
  }
};

TEST_CASE("after kill -9 right after its first join a key still owns its name",
          "[integration][names]") {
  const TempFolder folder;
  const auto config = [&] { return quiet_config(folder / "world"); };
  PublicKey owner{};
  {
    ServerProcess process(config);
    REQUIRE(process.port() != 0);
    NamedClient client(process.port(), "Ana");
    owner = client.hello(1).key;
    REQUIRE(client.join(1).has_value());
    process.kill();
  }
  ServerProcess process(config);
  REQUIRE(process.port() != 0);
  NamedClient other(process.port(), "ana");
  CHECK(other.refusal(2) == "the name \"ana\" belongs to the player with the key " +
                                key_fingerprint(owner) +
                                ": choose another name, or ask the server's host to release it");
  NamedClient again(process.port(), "ANA");
  CHECK(again.join(1).has_value());
  NamedClient guest(process.port(), "ana");
  guest.features = 0;
  CHECK_FALSE(guest.refusal(3).empty());
  CHECK(process.stop());
}

TEST_CASE("the host lists and releases names", "[integration][names]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const auto server = start_server(config, flat_creation());
  NamedClient client(server->port(), "the mole");
  REQUIRE(client.join(1).has_value());
  const std::string line = "\"the mole\" " + key_fingerprint(client.hello(1).key) + " #1\n";
  CHECK(control(config.world, {"names"}).text == line);
  CHECK(control(config.world, {"players"}).text.find(key_fingerprint(client.hello(1).key)) !=
        std::string::npos);
  CHECK_FALSE(control(config.world, {"names", "release", "the bat"}).is_ok);
  CHECK(control(config.world, {"names", "release", "The Mole"}).is_ok);
  CHECK(control(config.world, {"names"}).text == "nobody owns a name\n");
  NamedClient heir(server->port(), "the mole");
  CHECK(heir.join(2).has_value());
  CHECK(server->stop().is_clean);
}

TEST_CASE("many players claim their names at once", "[integration][names]") {
  const TempFolder folder;
  constexpr std::uint8_t kPlayers = 100;
  ServerConfig config = quiet_config(folder / "world");
  config.handshakes_per_address = kPlayers;
  const auto server = start_server(config, flat_creation());
  std::vector<std::future<bool>> joins;
  for (std::uint8_t who = 1; who <= kPlayers; ++who) {
    joins.push_back(std::async(std::launch::async, [who, port = server->port()] {
      NamedClient client(port, "player " + std::to_string(who));
      return client.join(who).has_value();
    }));
  }
  for (std::future<bool>& joined : joins) CHECK(joined.get());
  CHECK(server->stop().is_clean);
  const auto store = open_world(folder / "world", StoreAccess::read_only);
  REQUIRE(store.has_value());
  CHECK((*store)->name_claims()->size() == kPlayers);
}

TEST_CASE("a server refuses reserved names, also in disguise", "[integration][names]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.reserved_names = {"mayor"};
  const auto server = start_server(config, flat_creation());
  for (const char* name : {"server", "Mayor", "\uff41\uff44\uff4d\uff49\uff4e"}) {
    CAPTURE(name);
    NamedClient client(server->port(), name);
    CHECK(client.refusal(1).find("is reserved") != std::string::npos);
  }
  NamedClient client(server->port(), "a\u200bna");  // the codec refuses it
  client.send(client.hello(1));
  const auto goodbye = client.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::malformed_message);
}

}  // namespace
}  // namespace runstone::test
