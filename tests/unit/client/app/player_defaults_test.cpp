#include "client/app/player_defaults.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <vector>

#include "tests/support/core/temp_folder.hpp"

namespace runstone {
namespace {

ClientOptions parsed(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "runstone-client");
  const auto parsed = parse_options(static_cast<int>(arguments.size()), arguments.data());
  REQUIRE(parsed.options);
  return *parsed.options;
}

ClientSettings ana_settings(const std::string& key_file) {
  ClientSettings settings;
  settings.name = "ana";
  settings.key_file = key_file;
  settings.view_radius = 9;
  settings.far_levels = 7;
  settings.memory_mib = 2048;
  return settings;
}

}  // namespace

TEST_CASE("settings hold where the command line says nothing", "[client_app]") {
  const test::TempFolder folder;
  const ClientSettings settings = ana_settings(folder / "keys/ana");
  ClientOptions options = parsed({"--connect", "a"});
  apply_settings(settings, options);
  CHECK(options.name == "ana");
  CHECK(options.key_file == folder / "keys/ana");
  CHECK(options.view_radius == 9);
  CHECK(options.view_radius_v == 5);
  CHECK(options.far_levels == 7);
  CHECK(options.memory_mib == 2048);
  CHECK(std::filesystem::is_directory(folder / "keys"));
}

TEST_CASE("changed keys are used, and those that name nothing are reported", "[client_app]") {
  ClientSettings settings;
  settings.keys = {{"undo", "ctrl+U F9"}, {"redo", ""}, {"dance", "X"}, {"chat", "banana"}};
  std::vector<std::string> warnings;
  const KeyMap keys = key_map_of(settings, warnings);
  CHECK(keys.keys_of(Action::undo) == *parse_key_chords("ctrl+U F9"));
  CHECK(keys.keys_of(Action::redo).empty());
  CHECK(keys.keys_of(Action::chat) == KeyMap().keys_of(Action::chat));
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0] == "keys.chat: \"banana\" names no keys, such as \"ctrl+Z\"");
  CHECK(warnings[1] == "keys.dance: there is no such action");
}

TEST_CASE("options of the command line win over the settings", "[client_app]") {
  const test::TempFolder folder;
  ClientOptions options = parsed({"--connect", "a", "--name", "bea", "--key", "bea.key", "--view",
                                  "4", "--memory-mib", "100", "--far-levels", "0"});
  apply_settings(ana_settings(folder / "keys/ana"), options);
  CHECK(options.name == "bea");
  CHECK(options.key_file == "bea.key");
  CHECK(options.view_radius == 4);
  CHECK(options.view_radius_v == 2);
  CHECK(options.memory_mib == 100);
  CHECK(options.far_levels == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "keys"));
  ClientOptions flat = parsed({"--connect", "a", "--view-vertical", "1"});
  apply_settings(ana_settings(folder / "keys/ana"), flat);
  CHECK(flat.view_radius == 9);
  CHECK(flat.view_radius_v == 1);
}

}  // namespace runstone
