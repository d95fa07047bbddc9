// Backups of a world that a server runs, and a server on a restored world.
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>

#include "common/core/epoch_branch.hpp"
#include "server/app/backup_child.hpp"
#include "server/backup/backup_program.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kNowUs = 1'795'000'000'000'000;  // 2026-11-18

TEST_CASE("a world is backed up while a server runs it, and a server runs the restored one",
          "[integration]") {
  const TempFolder folder;
  const std::string world = folder / "world", copy = folder / "copy", back = folder / "back";
  Epoch before = 0;
  {
    const auto server = start_server(quiet_config(world), flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    before = client.welcome.epoch;
    std::ostringstream out;
    const auto done = back_up({world, copy, false}, kNowUs, out, {});
    INFO((done ? "" : done.error()));
    REQUIRE(done.has_value());
    CHECK_FALSE(std::filesystem::exists(copy + "/control.sock"));
    CHECK(server->stop().is_clean);
  }
  std::ostringstream out;
  REQUIRE(restore({copy, back, false}, kNowUs + 3'600'000'000, out).has_value());
  const auto server = start_server(quiet_config(back), flat_creation());
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  CHECK_FALSE(is_same_branch(client.welcome.epoch, before));
  CHECK(client.welcome.epoch > before);
}

TEST_CASE("the command backup starts the program and answers what it says", "[integration]") {
  ::setenv("RUNSTONE_SERVER", RUNSTONE_SERVER_PROGRAM, 1);
  const TempFolder folder;
  const std::string world = folder / "world", copy = folder / "copy";
  BackupChild backup(world);
  OperatorActions actions;
  actions.back_up = [&](const std::string& to, CommandReply reply) {
    backup.start(to, std::move(reply));
  };
  auto server = Server::start(quiet_config(world), flat_creation(), [] {}, actions);
  REQUIRE(server.has_value());
  const Answer done = control(world, {"backup", copy});
  INFO(done.text);
  CHECK(done.is_ok);
  CHECK(contains(done.text, "verified"));
  CHECK(std::filesystem::exists(copy + "/world.sqlite"));
  const Answer again = control(world, {"backup", copy});
  CHECK_FALSE(again.is_ok);
  CHECK(contains(again.text, "is not empty"));
  backup.stop();
  const Answer late = control(world, {"backup", folder / "late"});
  CHECK_FALSE(late.is_ok);
  CHECK(contains(late.text, "the server stops"));
}

TEST_CASE("a running server takes over new settings, or none if one is wrong", "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  Server* running = nullptr;
  Result<ServerConfig, std::string> next = config;
  OperatorActions actions;
  actions.reload = [&](CommandReply reply) { running->reload(next, std::move(reply)); };
  const auto server = Server::start(config, flat_creation(), [] {}, actions);
  REQUIRE(server.has_value());
  running = server->get();
  RawClient client((*server)->port());
  client.features = kFeatureCommands;
  REQUIRE(client.join(1).has_value());
  CHECK_FALSE(command(client, "status").is_ok);

  config.operators = {client.hello(1, 1).key};
  next = config;
  CHECK(control(config.world, {"reload"}).text == "reloaded: operators\n");
  CHECK(command(client, "status").is_ok);
  CHECK_FALSE(command(client, "reload").is_ok);
  CHECK_FALSE(command(client, "backup x").is_ok);

  next = failure("server.toml:3: idle_s: is out of range");
  const Answer wrong = control(config.world, {"reload"});
  CHECK_FALSE(wrong.is_ok);
  CHECK(contains(wrong.text, "server.toml:3"));
  CHECK(command(client, "status").is_ok);

  config.sessions_per_key = 1;
  config.memory_mib = 64;
  next = config;
  CHECK(control(config.world, {"reload"}).text ==
        "reloaded: sessions_per_key; after a restart: memory_mib\n");
  RawClient second((*server)->port());
  CHECK_FALSE(second.join(1, 2).has_value());
}

}  // namespace
}  // namespace runstone::test
