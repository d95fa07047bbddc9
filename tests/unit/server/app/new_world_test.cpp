#include "server/app/new_world.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("a folder without a world is refused unless a new world is wanted", "[server][app]") {
  const TempFolder folder;
  const std::string typo = folder / "valey";
  const auto refused = allow_new_world(typo, false);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error() == typo + ": holds no world; --create makes a new one there");
  CHECK(allow_new_world(typo, true).has_value());
}

TEST_CASE("a folder that holds a world needs no flag", "[server][app]") {
  const TempFolder folder;
  std::ofstream(folder / "world.sqlite") << "x";
  CHECK(allow_new_world(folder.path(), false).has_value());
  CHECK(allow_new_world(folder.path(), true).has_value());
}

TEST_CASE("the default folder gets a world without a flag", "[server][app]") {
  for (const std::string folder : {"world", "./world", "world/", "./world//"}) {
    CAPTURE(folder);
    CHECK(allow_new_world(folder, false).has_value());
  }
  CHECK_FALSE(allow_new_world("world2", false).has_value());
  CHECK_FALSE(allow_new_world("other/world", false).has_value());
}
