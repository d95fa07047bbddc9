#include "client/settings/world_kits.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

TEST_CASE("lines of worlds are kept on disk, those of the worlds that were played last",
          "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "state/worlds.toml";
  CHECK(load_kit(file, "00ff") == std::nullopt);
  REQUIRE(save_kit(file, "00ff", "voxel 0 1 2"));
  REQUIRE(save_kit(file, "aa", "sphere 1"));
  REQUIRE(save_kit(file, "00ff", "box 2"));
  CHECK(load_kit(file, "00ff") == "box 2");
  CHECK(load_kit(file, "aa") == "sphere 1");
  for (std::size_t i = 0; i < kWorldKitsMax - 1; ++i)
    REQUIRE(save_kit(file, "w" + std::to_string(i), "line"));
  CHECK(load_kit(file, "00ff") == "box 2");
  CHECK(load_kit(file, "aa") == std::nullopt);
}

TEST_CASE("lines that cannot be written are written later, the newest of each world",
          "[client_settings]") {
  const TempFolder folder;
  const std::string place = folder / "state", file = place + "/worlds.toml";
  std::ofstream(place) << "not a folder";
  UnsavedKits kits;
  kits.add("aa", "sphere 1");
  kits.add("bb", "voxel 2");
  CHECK_FALSE(kits.save(file));
  kits.add("aa", "box 2");
  CHECK_FALSE(kits.save(file));
  REQUIRE(std::filesystem::remove(place));
  REQUIRE(kits.save(file));
  CHECK(kits.empty());
  CHECK(load_kit(file, "aa") == "box 2");
  CHECK(load_kit(file, "bb") == "voxel 2");
}

TEST_CASE("a broken file of lines is kept aside", "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "worlds.toml";
  std::ofstream(file) << "world = [[\n";
  CHECK(load_kit(file, "00ff") == std::nullopt);
  CHECK(std::filesystem::exists(file + ".broken"));
  REQUIRE(save_kit(file, "00ff", "box 2"));
  CHECK(load_kit(file, "00ff") == "box 2");
  CHECK_FALSE(save_kit("", "00ff", "box 2"));
}

}  // namespace runstone::test
