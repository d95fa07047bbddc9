#include "client/local/local_worlds.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone {
namespace {

using test::TempFolder;

void make_world(const std::string& folder, int age_s) {
  std::filesystem::create_directories(folder);
  const std::string file = folder + "/world.sqlite";
  std::ofstream(file) << "x";
  std::filesystem::last_write_time(
      file, std::filesystem::file_time_type::clock::now() - std::chrono::seconds(age_s));
}

}  // namespace

TEST_CASE("local worlds are listed by their last change", "[client_local]") {
  const TempFolder folder;
  CHECK(list_local_worlds(folder / "missing").empty());
  make_world(folder / "valley", 300);
  make_world(folder / "old castle", 200);
  make_world(folder / "Tower_2", 100);
  std::filesystem::create_directories(folder / "empty");
  make_world(folder / "no/name", 0);
  make_world(folder / "b\u00e4d", 0);
  std::ofstream(folder / "valley/world.sqlite-wal") << "newer";
  const auto worlds = list_local_worlds(folder.path());
  REQUIRE(worlds.size() == 3);
  CHECK(worlds[0].name == "valley");
  CHECK(worlds[1].name == "Tower_2");
  CHECK(worlds[2].name == "old castle");
  CHECK(worlds[2].folder == folder / "old castle");
  CHECK(holds_world(worlds[2].folder));
  CHECK_FALSE(holds_world(folder / "empty"));
}

TEST_CASE("the name of a local world cannot leave its folder", "[client_local]") {
  for (const char* name : {"a", "My World", "x-1_2", "abcdefghijklmnopqrstuvwxyz012345"})
    CHECK(check_world_name(name));
  for (const char* name : {"", " a", "a ", ".", "..", "a/b", "a.b", "a\nb", "b\u00e4d", "a\"b",
                           "abcdefghijklmnopqrstuvwxyz0123456"}) {
    CAPTURE(name);
    CHECK_FALSE(check_world_name(name));
  }
}

}  // namespace runstone
