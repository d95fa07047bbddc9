#include "client/settings/hotbars_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

TEST_CASE("hotbars are read from the file as they were written", "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "state/hotbars.toml";
  CHECK(load_hotbars(file).empty());
  const HotbarRows hotbars = {{"a \"roof\"", {"stone", "", "mod:oak_stairs[facing=east]"}},
                              {"walls", std::vector<std::string>(9, "brick")}};
  REQUIRE(save_hotbars(file, hotbars));
  CHECK(load_hotbars(file) == hotbars);
  REQUIRE(save_hotbars(file, {}));
  CHECK(load_hotbars(file).empty());
  CHECK_FALSE(save_hotbars("", hotbars));
}

TEST_CASE("rows of hotbars that are wrong are left out, and a broken file is kept aside",
          "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "hotbars.toml";
  std::ofstream(file) << "hotbar = [{name = 3, slots = []}, {name = \"a\"}, 5,\n"
                         "{name = \"b\", slots = [1, \"stone\"]},\n"
                         "{name = \"c\", slots = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]}]\n";
  CHECK(load_hotbars(file) == HotbarRows{{"b", {"", "stone"}}});
  std::ofstream(file) << "hotbar = [[\n";
  CHECK(load_hotbars(file).empty());
  CHECK(std::filesystem::exists(file + ".broken"));
}

}  // namespace runstone::test
