// Roles, protected ground and bans on a running server, by commands of control and of clients, and
// after a restart.
#include <catch2/catch.hpp>
#include <string>

#include "protocol/codec/key_fingerprint.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
TEST_CASE("roles, ground and bans hold at once and after a restart", "[integration][rights]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const std::string& world = config.world;
  {
    auto server = start_server(config, flat_creation());
    RawClient ana(server->port()), mole(server->port());
    ana.features = mole.features = kFeatureCommands;
    REQUIRE(ana.join(1).has_value());
    REQUIRE(mole.join(2).has_value());
    CHECK(command(ana, "log").text ==
          "this command needs the right roll_back; your role is builder\n");
    must(world, {"grant", "player1", "moderator"});
    REQUIRE(ana.sees_durable(1));
    CHECK(command(ana, "log cause rights").text.find(" rights gave ") != std::string::npos);
    CHECK(command(ana, "why player2 build 0 70 0").text.starts_with("yes: player2 #2 "));

    CHECK(command(ana, "claim home 0 60 0 9 80 9").is_ok);
    mole.send(EditRequest{1, 0, {SetVoxel{{9, 80, 9}}, {}, 1}});
    REQUIRE(mole.next_of<Reject>().has_value());
    CHECK(command(mole, "protect home add player2").text.find("belongs to somebody else") !=
          std::string::npos);
    CHECK(command(ana, "protect home add player2").is_ok);
    mole.send(EditRequest{2, 0, {SetVoxel{{9, 80, 9}}, {}, 1}});
    CHECK(mole.next_of<Commit>().has_value());

    CHECK(command(ana, "ban player2 for 1h reason \"broke the bridge\"").is_ok);
    const auto goodbye = mole.goodbye();
    REQUIRE(goodbye.has_value());
    CHECK(goodbye->text.find("broke the bridge") != std::string::npos);
    CHECK(server->stop().is_clean);
  }
  auto server = start_server(config, flat_creation());
  RawClient mole(server->port());
  mole.send(mole.hello(2));
  CHECK(must(world, {"bans"}).text.find("\"broke the bridge\"; record ") != std::string::npos);
  CHECK(
      must(world, {"protected", "at", "9", "80", "9"}).text.starts_with("home: 0 60 0 to 9 80 9"));
  const std::string list = must(world, {"log", "cause", "rights", "limit", "1"}).text;
  must(world, {"rights", "undo", list.substr(0, list.find(' '))});
  RawClient again(server->port());
  CHECK(again.join(2).has_value());
  CHECK(server->stop().is_clean);
}

}  // namespace runstone::test
