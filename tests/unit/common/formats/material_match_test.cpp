#include "common/formats/material_match.hpp"

#include <catch2/catch.hpp>

#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {

TEST_CASE("the name of a world's row has the states of a material once", "[formats]") {
  const auto name = [](const char* of, const char* states) {
    return world_name_of(file_material(of, states, {1, 2, 3, 255}));
  };
  CHECK(name("Stair", "param2=3") == "Stair[param2=3]");
  CHECK(name("stairs:stair_wood[param2=3]", "param2=3") == "stairs:stair_wood[param2=3]");
  CHECK(name("minecraft:oak_stairs[facing=east]", "facing=east,half=bottom") ==
        "minecraft:oak_stairs[facing=east]");
  CHECK(name("stone", "") == "stone");
}

}  // namespace runstone::test
