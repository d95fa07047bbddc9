// The real client program from its title screen: a world on this computer in one click, and the words
// for each reason why a player is not on a server.
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>

#include "tests/integration/client/window/title_bench.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"

namespace runstone {
namespace {

using test::control;
using test::flat_creation;
using test::has_display_programs;
using test::kWait;
using test::quiet_config;
using test::start_server;
using test::text_in;
using test::TitleBench;
using test::wait_for;

}  // namespace

TEST_CASE("without arguments the client builds in a local world, leaves it and comes back to it",
          "[integration]") {
  if (!has_display_programs()) return;
  TitleBench bench;
  bench.start({});
  bench.press_first_button(0);
  REQUIRE(bench.logs("ground in view"));
  // A click captures the mouse. The player looks at the ground and removes a voxel.
  REQUIRE(bench.display.hand({"mousemove", "320", "150", "click", "1"}));
  for (int step = 0; step < 4; ++step)
    REQUIRE(bench.display.hand({"mousemove_relative", "--", "0", "80"}));
  const std::string server_log = bench.folder / "data/runstone/worlds/home/server.log";
  REQUIRE(bench.display.hand({"click", "1"}));
  bench.leave();
  CHECK(wait_for(kWait,
                 [&] { return text_in(server_log).find("stopped seq=") != std::string::npos; }));
  INFO(text_in(server_log));
  CHECK(text_in(server_log).find("stopped seq=1 ") != std::string::npos);
  bench.press_first_button(1);
  CHECK(bench.logs("head=1 durable=1"));
  REQUIRE(bench.logs("ground in view", 2));
  REQUIRE(bench.display.hand({"mousemove", "320", "150", "click", "1"}));
  CHECK(bench.quit() == 0);
}

TEST_CASE("the client says in words why it is not on a server, and goes on", "[integration]") {
  if (!has_display_programs()) return;
  TitleBench bench;
  ServerConfig config = quiet_config(bench.folder / "world");
  config.idle_s = 3'600;
  const auto server = start_server(config, flat_creation());
  const std::string address = "127.0.0.1:" + std::to_string(server->port());
  const std::string key = bench.folder / "ana.key";
  const std::vector<std::string> join = {
      "--connect", address, "--key", key, "--name", "ana", "--reconnect-seconds", "20"};
  bench.start(join);
  REQUIRE(bench.logs("ground in view"));
  CHECK(text_in(bench.folder / "state/runstone/servers.toml").find(address) != std::string::npos);

  REQUIRE(control(config.world, {"ban", "ana", "reason", "cow-painting"}).is_ok);
  CHECK(bench.logs("The server does not admit you"));
  CHECK(bench.logs("cow-painting"));
  REQUIRE(control(config.world, {"unban", "ana"}).is_ok);

  std::vector<std::string> other = join;
  other[3] = bench.folder / "bea.key";
  bench.start(other);
  CHECK(bench.logs("The server refuses this name"));

  // Another key than the one that was pinned at the first join.
  const std::string pins = text_in(key + ".servers");
  REQUIRE(pins.size() > 40);
  std::ofstream(key + ".servers") << pins.substr(0, 33) << std::string(64, 'a') << "\n";
  bench.start(join);
  CHECK(bench.logs("This is not the server that you know"));
  CHECK(bench.logs("is pinned as"));
  std::ofstream(key + ".servers") << pins;

  REQUIRE(control(config.world, {"role", "default", "nobody"}).is_ok);
  REQUIRE(control(config.world, {"password", "set"}, [] {
            return Result<std::string, std::string>("blue cheese 42");
          }).is_ok);
  bench.start({"--connect", address, "--key", bench.folder / "cleo.key", "--name", "cleo"});
  REQUIRE(bench.logs("asks for the password of " + address));
  REQUIRE(wait_for(kWait, [&] {  // the field has the keyboard once it is drawn
    static_cast<void>(bench.display.hand({"type", "--delay", "60", "blue cheese 42"}));
    bench.press({"Return"});
    return wait_for(std::chrono::seconds(3),
                    [&] { return text_in(bench.log).find("world open") != std::string::npos; });
  }));

  bench.start({"--connect", "127.0.0.1:1", "--reconnect-seconds", "1"});
  CHECK(bench.logs("No server listens at 127.0.0.1:1"));
  bench.start({"--connect", "no-such-host.invalid", "--reconnect-seconds", "1"});
  CHECK(bench.logs("There is no computer with this name"));
}

TEST_CASE("a key file and settings that cannot be used are reported on the title screen",
          "[integration]") {
  if (!has_display_programs()) return;
  TitleBench bench;
  std::filesystem::create_directories(bench.folder / "config/runstone");
  std::ofstream(bench.folder / "config/runstone/client.toml") << "name = \"ana\n";
  const std::string key = bench.folder / "bad.key";
  std::ofstream(key) << "no key\n";
  std::filesystem::permissions(key, std::filesystem::perms::owner_read);
  bench.start({"--key", key});
  CHECK(bench.logs("the default settings are used"));
  CHECK(bench.logs("bad.key: is not a key file"));
}

}  // namespace runstone
