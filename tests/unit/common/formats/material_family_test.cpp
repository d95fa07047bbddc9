#include "common/formats/material_family.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace runstone::test {
namespace {

MaterialTable family_table(const std::vector<std::string>& names) {
  MaterialTable out;
  for (const std::string& name : names) {
    MaterialInfo info;
    info.name = name;
    REQUIRE(out.add(std::move(info)));
  }
  return out;
}

std::string nearest_name(const MaterialTable& table, std::string_view wanted) {
  const auto found = nearest_member(table, states_of_material(wanted));
  return found ? table[*found].name : "none";
}

}  // namespace

TEST_CASE("a name has a family and states, those at their defaults included", "[formats][family]") {
  const MaterialStates stairs = states_of_material("minecraft:oak_stairs[facing=east]");
  CHECK(stairs.family == "minecraft:oak_stairs");
  CHECK(stairs.path() == "oak_stairs");
  CHECK(stairs.get("facing") == "east");
  CHECK(stairs.get("half") == "bottom");
  CHECK(stairs.get("none").empty());
  const MaterialStates own = states_of_material("fir_stairs[half=top]");
  CHECK(own.family == "fir_stairs");
  CHECK(own.get("half") == "top");
  CHECK(own.get("facing") == "north");
  CHECK(states_of_material("default:fence_wood").states.size() == 1);  // param2
  CHECK(states_of_material("stairs:stair_wood[param2=7]").get("param2") == "7");
  CHECK(states_of_material("minecraft:redstone_wire[power=7]").family == "minecraft:redstone_wire");
  CHECK(states_of_material("stone").states.empty());
  CHECK(states_of_material("odd[").family == "odd");
}

TEST_CASE("a table knows the members of a family", "[formats][family]") {
  const MaterialTable table =
      family_table({"oak", "oak_stairs", "oak[a=b]", "oak{c=d}", "oak~01", "oakum"});
  CHECK(table.family("oak") == std::vector<Material>{1, 3, 4, 5});
  CHECK(table.family("oak_stairs") == std::vector<Material>{2});
  CHECK(table.family("ash").empty());
}

TEST_CASE("the nearest member differs in the fewest states", "[formats][family]") {
  const MaterialTable table = family_table(
      {"minecraft:oak_stairs[facing=east]", "minecraft:oak_stairs[facing=west,half=top]",
       "minecraft:oak_stairs[facing=south,half=top]", "minecraft:oak_fence",
       "minecraft:cobblestone_wall[east=true]", "minecraft:cobblestone_wall[north=true]"});
  CHECK(nearest_name(table, "minecraft:oak_stairs[facing=west,half=top]") ==
        "minecraft:oak_stairs[facing=west,half=top]");
  CHECK(nearest_name(table, "minecraft:oak_stairs[facing=west]") ==
        "minecraft:oak_stairs[facing=east]");  // the first of those that differ in one state
  CHECK(nearest_name(table, "minecraft:oak_stairs[facing=south]") ==
        "minecraft:oak_stairs[facing=east]");
  CHECK(nearest_name(table, "minecraft:oak_fence[east=true]") == "minecraft:oak_fence");
  CHECK(nearest_name(table, "minecraft:cobblestone_wall[north=low]") ==
        "minecraft:cobblestone_wall[north=true]");
  CHECK(nearest_name(table, "minecraft:birch_stairs") == "none");
  CHECK(nearest_name(table, "") == "none");
}

}  // namespace runstone::test
