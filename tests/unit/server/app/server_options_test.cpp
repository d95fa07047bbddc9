#include "server/app/server_options.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace runstone;

namespace {

ParsedServerOptions parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "runstone-server");
  return parse_server_options(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace

TEST_CASE("of two equal flags the last one counts", "[server_options]") {
  const auto parsed =
      parse({"--world", "/world", "--listen", "0.0.0.0:4747", "--listen", "127.0.0.1:5000"});
  REQUIRE(parsed.options);
  CHECK(parsed.options->settings.at("listen") == "127.0.0.1:5000");
  CHECK(parsed.options->settings.at("world") == "/world");

  const auto import = parse({"import", "--luanti", "a", "--world", "b", "--world", "c"});
  REQUIRE(import.options);
  REQUIRE(import.options->import);
  CHECK(import.options->import->world == "c");
}

TEST_CASE("what follows control is the command, whatever it looks like", "[server_options]") {
  const auto parsed =
      parse({"control", "--world", "valley", "log", "box", "-1", "2", "3", "-4", "5", "6"});
  REQUIRE(parsed.options);
  REQUIRE(parsed.options->control);
  CHECK(parsed.options->control->world == "valley");
  CHECK(parsed.options->control->words ==
        std::vector<std::string>{"log", "box", "-1", "2", "3", "-4", "5", "6"});
  const auto none = parse({"control", "--world", "valley"});
  CHECK_FALSE(none.options);
  CHECK(none.exit_code == 2);
}

TEST_CASE("an unknown flag ends the program with 2", "[server_options]") {
  const auto parsed = parse({"--worlds", "/world"});
  CHECK_FALSE(parsed.options);
  CHECK(parsed.exit_code == 2);
}
