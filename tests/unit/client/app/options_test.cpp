#include "client/app/options.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <vector>

#include "client/app/player_defaults.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;

namespace {

ParsedOptions parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "runstone-client");
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

ClientOptions accepted(std::vector<const char*> arguments) {
  const ParsedOptions parsed = parse(std::move(arguments));
  REQUIRE(parsed.options.has_value());
  return *parsed.options;
}

int refused(std::vector<const char*> arguments) {
  const ParsedOptions parsed = parse(std::move(arguments));
  REQUIRE_FALSE(parsed.options.has_value());
  return parsed.exit_code;
}

}  // namespace

TEST_CASE("the connection is encrypted unless the user says otherwise", "[client_app]") {
  CHECK(accepted({"--connect", "a:1"}).tls.has_value());
  CHECK_FALSE(accepted({"--connect", "a:1", "--insecure"}).tls.has_value());
  CHECK(refused({"--connect", "runstone://a/#token", "--headless"}) == 2);  // the key would be lost
  CHECK(accepted({"--connect", "runstone://a/#token"}).ticket == "token");  // a window keeps a key
  CHECK(refused({"--connect", "runstone://"}) == 2);
  CHECK(refused({"--connect", "a:1", "--ca", ""}) == 2);
  CHECK(refused({"--connect", "a:1", "--ca", "/nowhere/authority.pem"}) == 2);
  CHECK(refused({"--connect", "a:1", "--ca", "system", "--insecure"}) == 2);
}

TEST_CASE("the address is a host with or without a port, also in IPv6", "[client_app]") {
  CHECK(accepted({"--connect", "example.org:4000"}).server == HostPort{"example.org", 4000});
  CHECK(accepted({"--connect", "[::1]:4000"}).server == HostPort{"::1", 4000});
  CHECK(accepted({"--connect", "localhost"}).server == HostPort{"localhost", 4747});
  CHECK(accepted({"--connect", "::1"}).server == HostPort{"::1", 4747});
  CHECK(refused({"--connect", "example.org:0"}) == 2);
  CHECK(refused({"--connect", "example.org:65536"}) == 2);
  CHECK(refused({"--connect", ":4000"}) == 2);
  CHECK(accepted({"--connect", "a"}).more_servers.empty());
  const ClientOptions several = accepted({"--connect", "runstone://a,b:5/#token"});
  CHECK(several.server == HostPort{"a", 4747});
  CHECK(several.more_servers == std::vector<HostPort>{{"b", 5}});
  CHECK(several.ticket == "token");
  CHECK(refused({"--connect", "a,"}) == 2);
}

TEST_CASE(
    "a client without a server shows the title screen, and needs a window and a player for it",
    "[client_app]") {
  CHECK_FALSE(accepted({}).has_server);
  CHECK(accepted({}).local_world.empty());
  CHECK(accepted({"--connect", "a"}).has_server);
  CHECK(refused({"--headless"}) == 2);
  CHECK(refused({"--no-render"}) == 2);
  CHECK(refused({"--script", "/dev/null"}) == 2);
}

TEST_CASE("a local world is joined instead of a server", "[client_app]") {
  const ClientOptions options = accepted({"--local", "my world", "--headless"});
  CHECK(options.local_world == "my world");
  CHECK(options.local_creation == NewLocalWorld{"landscape", std::nullopt});
  CHECK(accepted({"--local", "w", "--generator", "flat", "--seed", "7"}).local_creation ==
        NewLocalWorld{"flat", 7});
  CHECK(refused({"--local", "w", "--connect", "a"}) == 2);
  CHECK(refused({"--local", "w", "--generator", "marzipan"}) == 2);
  CHECK(refused({"--connect", "a", "--seed", "7"}) == 2);
}

TEST_CASE("a link gives the address and the invite", "[client_app]") {
  const ClientOptions options =
      accepted({"--connect", "runstone://example.org:5000/#token", "--key", "k"});
  CHECK(options.server.host == "example.org");
  CHECK(options.server.port == 5000);
  CHECK(options.ticket == "token");
  CHECK(accepted({"--connect", "runstone://example.org"}).ticket.empty());
  const ClientOptions clicked = accepted({"runstone://example.org:5000/#token"});
  CHECK(clicked.server == options.server);
  CHECK(clicked.ticket == "token");
  CHECK(refused({"runstone://a", "--connect", "b"}) == 2);
}

TEST_CASE("a password comes from a file, for an identity that is kept, and encrypted",
          "[client_app]") {
  const runstone::test::TempFolder folder;
  const std::string file = folder / "password";
  const char* const path = file.c_str();
  CHECK(accepted({"--connect", "a"}).password.empty());
  CHECK(refused({"--connect", "a", "--key", "k", "--password-file", path}) == 2);  // no such file
  std::ofstream(file) << "blue cheese 42\nnot this\n";
  CHECK(accepted({"--connect", "a", "--key", "k", "--password-file", path}).password ==
        "blue cheese 42");
  std::ofstream(file) << "\xEF\xBB\xBF"
                         "blue cheese 42\r\nnot this\r\n";
  CHECK(accepted({"--connect", "a", "--key", "k", "--password-file", path}).password ==
        "blue cheese 42");
  CHECK(refused({"--connect", "a", "--password-file", path}) == 2);
  CHECK(refused({"--connect", "a", "--key", "k", "--insecure", "--password-file", path}) == 2);
}

TEST_CASE("the mode --draw requires no server and accepts none", "[client_app]") {
  CHECK(accepted({"--draw"}).draw);
  CHECK(accepted({"--draw", "--workers", "3"}).workers == 3);
  CHECK_FALSE(accepted({"--connect", "a:1"}).draw);
  CHECK(refused({"--draw", "--connect", "a:1"}) == 2);
  CHECK(refused({"--draw", "--size", "64x64"}) == 2);
  CHECK(refused({"--draw", "--no-render"}) == 2);
  CHECK(refused({"--draw", "--help"}) == 0);
}

TEST_CASE("a client that lists materials draws nothing and plays no script", "[client_app]") {
  const ClientOptions options = accepted({"--connect", "a:1", "--materials"});
  CHECK(options.list_materials);
  CHECK_FALSE(options.render);
  CHECK_FALSE(options.cache);
  CHECK_FALSE(accepted({"--connect", "a:1"}).list_materials);
  CHECK(refused({"--materials"}) == 2);
  CHECK(refused({"--connect", "a:1", "--materials", "--report", "x"}) == 2);
  CHECK(refused({"--draw", "--materials"}) == 2);
}

TEST_CASE("a client with a window has a cache, and other clients have one if an option asks for it",
          "[client_app]") {
  CHECK(accepted({"--connect", "a:1"}).cache);
  CHECK(accepted({"--connect", "a:1"}).cache_mib == 256);
  CHECK_FALSE(accepted({"--connect", "a:1", "--no-cache"}).cache);
  CHECK_FALSE(accepted({"--connect", "a:1", "--headless"}).cache);
  CHECK_FALSE(accepted({"--connect", "a:1", "--no-render"}).cache);
  CHECK(accepted({"--connect", "a:1", "--headless", "--cache-dir", "/tmp/x"}).cache);
  CHECK(accepted({"--connect", "a:1", "--no-render", "--cache-mib", "9"}).cache);
  CHECK_FALSE(accepted({"--connect", "a:1", "--cache-dir", "/tmp/x", "--no-cache"}).cache);
  CHECK(refused({"--connect", "a:1", "--cache-mib", "0"}) == 2);
}

TEST_CASE("the memory budget is found by itself unless an option says otherwise", "[client_app]") {
  CHECK(accepted({"--connect", "a:1"}).memory_mib == 0);
  CHECK(automatic_memory_mib() >= 256);
  CHECK(automatic_memory_mib() <= 1024);
  CHECK(accepted({"--connect", "a:1", "--memory-mib", "64"}).memory_mib == 64);
  CHECK(refused({"--connect", "a:1", "--memory-mib", "63"}) == 2);
  CHECK(refused({"--connect", "a:1", "--memory-mib", "65537"}) == 2);
}

TEST_CASE("protected boxes are outlined from the start if an option says so", "[client_app]") {
  CHECK_FALSE(accepted({"--connect", "a:1"}).show_protected);
  CHECK(accepted({"--connect", "a:1", "--show-protected"}).show_protected);
}

TEST_CASE("of two values of one flag the last one counts", "[client_app]") {
  CHECK(accepted({"--connect", "a:1", "--connect", "b:2"}).server.host == "b");
}

TEST_CASE("sizes, views and encodings become numbers", "[client_app]") {
  const ClientOptions options = accepted({"--connect", "a:1", "--size", "640x360", "--view", "9",
                                          "--encoding", "packed", "--headless"});
  CHECK(options.width == 640);
  CHECK(options.height == 360);
  CHECK(options.view_radius == 9);
  CHECK(options.view_radius_v == 5);
  CHECK(options.encodings == 2);
  CHECK(accepted({"--connect", "a:1", "--encoding", "coded"}).encodings == 4);
  CHECK(accepted({"--connect", "a:1"}).encodings == 7);
  CHECK(options.headless);
  CHECK(options.render);
  CHECK(options.workers >= 1);
  CHECK(accepted({"--connect", "a:1", "--view", "9", "--view-vertical", "0"}).view_radius_v == 0);
  CHECK_FALSE(accepted({"--connect", "a:1", "--no-render"}).render);
  CHECK(refused({"--connect", "a:1", "--size", "640"}) == 2);
  CHECK(refused({"--connect", "a:1", "--size", "1x1"}) == 2);
  CHECK(refused({"--connect", "a:1", "--view", "65"}) == 2);
  CHECK(accepted({"--connect", "a:1"}).far_levels == 0);
  CHECK(accepted({"--connect", "a:1", "--far-levels", "6"}).far_levels == 6);
  CHECK(refused({"--connect", "a:1", "--far-levels", "9"}) == 2);
  CHECK(refused({"--connect", "a:1", "--view", "1", "--far-levels", "3"}) == 2);
  CHECK(refused({"--connect", "a:1", "--encoding", "morse"}) == 2);
  CHECK(refused({"--connect", "a:1", "--script", "/does/not/exist"}) == 2);
  CHECK(refused({"--connect", "a:1", "--name", "a name of more than thirty-two bytes"}) == 2);
  CHECK(refused({"--help"}) == 0);
}
