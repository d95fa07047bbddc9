#include "client/settings/recent_servers.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone {
namespace {

using test::TempFolder;

RecentServer server(const std::string& address, TimeUs joined_us) {
  return {address, "00ff", "ana", joined_us};
}

}  // namespace

TEST_CASE("a server that is joined again moves to the front of the list", "[client_settings]") {
  std::vector<RecentServer> servers;
  for (int i = 0; i < 20; ++i) add_recent(servers, server("host" + std::to_string(i) + ":1", i));
  REQUIRE(servers.size() == kRecentServersMax);
  CHECK(servers.front().address == "host19:1");
  add_recent(servers, server("host10:1", 99));
  REQUIRE(servers.size() == kRecentServersMax);
  CHECK(servers[0] == server("host10:1", 99));
  CHECK(servers[1].address == "host19:1");
  CHECK(servers.back().address == "host4:1");
}

TEST_CASE("the list of servers is kept on disk", "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "state/servers.toml";
  CHECK(load_recent_servers(file).servers.empty());
  const RecentServer odd{"[::1]:4747", "00ff", "Ana \u00e9", 1'700'000'000'000'000};
  REQUIRE(save_recent_server(file, server("a:1", 1)));
  REQUIRE(save_recent_server(file, odd));
  const LoadedServers loaded = load_recent_servers(file);
  CHECK(loaded.warning.empty());
  CHECK(loaded.servers == std::vector<RecentServer>{odd, server("a:1", 1)});
}

TEST_CASE("a broken list of servers is kept aside, and an entry without a field is left out",
          "[client_settings]") {
  const auto read = read_recent_servers(
      "[[server]]\naddress = \"a:1\"\n[[server]]\naddress = \"b:1\"\nworld = \"\"\nname = \"x\"\n"
      "joined_us = 4\n[[server]]\naddress = \"c\\n:1\"\nworld = \"\"\nname = \"x\"\njoined_us = 4\n");
  REQUIRE(read);
  REQUIRE(read->size() == 1);
  CHECK(read->front().address == "b:1");
  const TempFolder folder;
  const std::string file = folder / "servers.toml";
  std::ofstream(file) << "server = [[\n";
  const LoadedServers loaded = load_recent_servers(file);
  CHECK(loaded.servers.empty());
  CHECK_THAT(loaded.warning, Catch::Contains("kept as " + file + ".broken"));
  CHECK(std::filesystem::exists(file + ".broken"));
  REQUIRE(save_recent_server(file, server("a:1", 1)));
  CHECK(load_recent_servers(file).servers.size() == 1);
}

}  // namespace runstone
