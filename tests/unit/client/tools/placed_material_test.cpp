#include "client/tools/placed_material.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/client/tools/hands_table.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

constexpr LookDirection kNorth{0, -0.2, -0.97}, kEast{0.97, -0.2, 0}, kSouth{0, -0.2, 0.97},
    kWest{-0.97, -0.2, 0}, kDown{0.1, -0.99, 0};

/// A table of every member of a block, in which the other states have their defaults.
MaterialTable full_table() {
  return hands_table({"stone",
                      "minecraft:oak_stairs",
                      "minecraft:oak_stairs[facing=east]",
                      "minecraft:oak_stairs[facing=south]",
                      "minecraft:oak_stairs[facing=west]",
                      "minecraft:oak_stairs[half=top]",
                      "minecraft:oak_stairs[facing=east,half=top]",
                      "minecraft:oak_slab",
                      "minecraft:oak_slab[type=top]",
                      "minecraft:oak_log",
                      "minecraft:oak_log[axis=x]",
                      "minecraft:oak_log[axis=z]",
                      "minecraft:oak_door",
                      "minecraft:oak_door[facing=east]",
                      "minecraft:furnace",
                      "minecraft:furnace[facing=west]",
                      "minecraft:furnace[facing=south]",
                      "minecraft:torch",
                      "minecraft:wall_torch",
                      "minecraft:wall_torch[facing=east]",
                      "minecraft:ladder[facing=west]",
                      "minecraft:ladder",
                      "minecraft:stone_button",
                      "minecraft:stone_button[face=floor]",
                      "minecraft:stone_button[face=ceiling]",
                      "minecraft:oak_sign",
                      "minecraft:oak_sign[rotation=4]",
                      "minecraft:oak_sign[rotation=8]",
                      "minecraft:oak_wall_sign[facing=south]",
                      "minecraft:oak_trapdoor",
                      "minecraft:oak_trapdoor[facing=east,half=top]",
                      "minecraft:barrel",
                      "minecraft:barrel[facing=up]",
                      "minecraft:lantern",
                      "minecraft:lantern[hanging=true]",
                      "minecraft:rail",
                      "minecraft:rail[shape=east_west]",
                      "minecraft:oak_fence_gate",
                      "minecraft:oak_fence_gate[facing=east]",
                      "minecraft:end_rod",
                      "minecraft:end_rod[facing=down]"});
}

std::string placed(std::string_view held, Direction face, double height,
                   const LookDirection& look) {
  const MaterialTable table = full_table();
  return table[placed_material(id_in(table, held), {face, height, look}, table)].name.substr(
      std::string_view("minecraft:").size());
}

}  // namespace

TEST_CASE("stairs ascend away from the player, in the half that was clicked", "[tools][hands]") {
  const auto stairs = [](Direction face, double height, const LookDirection& look) {
    return placed("minecraft:oak_stairs[facing=west]", face, height, look);
  };
  CHECK(stairs(Direction::pos_y, 1, kNorth) == "oak_stairs");
  CHECK(stairs(Direction::pos_y, 1, kEast) == "oak_stairs[facing=east]");
  CHECK(stairs(Direction::pos_y, 1, kSouth) == "oak_stairs[facing=south]");
  CHECK(stairs(Direction::pos_y, 1, kWest) == "oak_stairs[facing=west]");
  CHECK(stairs(Direction::neg_y, 0, kNorth) == "oak_stairs[half=top]");
  CHECK(stairs(Direction::pos_z, 0.9, kNorth) == "oak_stairs[half=top]");
  CHECK(stairs(Direction::pos_z, 0.1, kNorth) == "oak_stairs");
  CHECK(stairs(Direction::neg_x, 0.6, kEast) == "oak_stairs[facing=east,half=top]");
}

TEST_CASE("the nearest member that the table has is placed", "[tools][hands]") {
  // South upside down is missing. The others differ in one state.
  CHECK(placed("minecraft:oak_stairs[facing=south]", Direction::neg_y, 0, kSouth) ==
        "oak_stairs[facing=south]");
  const MaterialTable one = hands_table({"minecraft:oak_stairs[facing=east]"});
  CHECK(placed_material(1, {Direction::neg_y, 0, kWest}, one) == 1);
}

TEST_CASE("slabs, logs, doors and furnaces lie as the click means", "[tools][hands]") {
  CHECK(placed("minecraft:oak_slab", Direction::neg_y, 0, kEast) == "oak_slab[type=top]");
  CHECK(placed("minecraft:oak_slab[type=top]", Direction::pos_y, 1, kEast) == "oak_slab");
  CHECK(placed("minecraft:oak_slab", Direction::pos_x, 0.75, kWest) == "oak_slab[type=top]");
  CHECK(placed("minecraft:oak_log[axis=x]", Direction::neg_y, 0, kEast) == "oak_log");
  CHECK(placed("minecraft:oak_log", Direction::neg_x, 0.5, kEast) == "oak_log[axis=x]");
  CHECK(placed("minecraft:oak_log", Direction::pos_z, 0.5, kNorth) == "oak_log[axis=z]");
  CHECK(placed("minecraft:oak_door", Direction::pos_y, 1, kEast) == "oak_door[facing=east]");
  CHECK(placed("minecraft:oak_fence_gate", Direction::pos_y, 1, kEast) ==
        "oak_fence_gate[facing=east]");
  CHECK(placed("minecraft:furnace", Direction::pos_y, 1, kEast) == "furnace[facing=west]");
  CHECK(placed("minecraft:furnace[facing=west]", Direction::pos_y, 1, kSouth) == "furnace");
  CHECK(placed("minecraft:oak_trapdoor", Direction::pos_x, 0.8, kWest) ==
        "oak_trapdoor[facing=east,half=top]");
  CHECK(placed("minecraft:barrel", Direction::pos_y, 1, kDown) == "barrel[facing=up]");
  CHECK(placed("minecraft:rail", Direction::pos_y, 1, kWest) == "rail[shape=east_west]");
  CHECK(placed("minecraft:end_rod", Direction::neg_y, 0, kEast) == "end_rod[facing=down]");
}

TEST_CASE("what hangs on a wall hangs on the face that was clicked", "[tools][hands]") {
  CHECK(placed("minecraft:torch", Direction::pos_x, 0.5, kWest) == "wall_torch[facing=east]");
  CHECK(placed("minecraft:torch", Direction::neg_z, 0.5, kSouth) == "wall_torch");
  CHECK(placed("minecraft:wall_torch", Direction::pos_y, 1, kWest) == "torch");
  CHECK(placed("minecraft:ladder", Direction::neg_x, 0.5, kEast) == "ladder[facing=west]");
  CHECK(placed("minecraft:stone_button", Direction::pos_y, 1, kNorth) ==
        "stone_button[face=floor]");
  CHECK(placed("minecraft:stone_button", Direction::neg_y, 0, kNorth) ==
        "stone_button[face=ceiling]");
  CHECK(placed("minecraft:oak_sign", Direction::pos_z, 0.5, kNorth) ==
        "oak_wall_sign[facing=south]");
  // A sign faces the player: 0 is south, 4 west, 8 north.
  CHECK(placed("minecraft:oak_sign[rotation=8]", Direction::pos_y, 1, kNorth) == "oak_sign");
  CHECK(placed("minecraft:oak_sign", Direction::pos_y, 1, kEast) == "oak_sign[rotation=4]");
  CHECK(placed("minecraft:oak_sign", Direction::pos_y, 1, kSouth) == "oak_sign[rotation=8]");
  CHECK(placed("minecraft:lantern", Direction::neg_y, 0, kEast) == "lantern[hanging=true]");
  const MaterialTable no_wall = hands_table({"minecraft:torch"});
  CHECK(placed_material(1, {Direction::pos_x, 0.5, kWest}, no_wall) == 1);
}

TEST_CASE("materials without states, and names of a table's own, are placed as their names say",
          "[tools][hands]") {
  const MaterialTable table = hands_table(
      {"stone", "fir_stairs[facing=north]", "fir_stairs[facing=east]", "stairs:stair_wood",
       "stairs:stair_wood[param2=1]", "stairs:slab_wood", "stairs:slab_wood[param2=20]",
       "default:torch_wall[param2=2]", "default:torch_wall[param2=3]"});
  const PlacedClick east{Direction::pos_y, 1, kEast};
  CHECK(placed_material(1, east, table) == 1);
  CHECK(placed_material(kEmpty, east, table) == kEmpty);
  CHECK(placed_material(99, east, table) == 99);
  CHECK(placed_material(2, east, table) == 3);
  CHECK(placed_material(4, east, table) == 5);
  CHECK(placed_material(5, {Direction::pos_y, 1, kSouth}, table) == 4);
  CHECK(placed_material(6, {Direction::neg_y, 0, kSouth}, table) == 7);
  CHECK(placed_material(7, {Direction::pos_y, 0, kSouth}, table) == 6);
  // The wall is behind the face.
  CHECK(placed_material(8, {Direction::pos_x, 0.5, kWest}, table) == 9);
}

TEST_CASE("a click knows its height in the voxel that was hit", "[tools][hands]") {
  Aim aim;
  aim.eye = {0.5, 11.75, 0.5};
  aim.look = {1, 0, 0};
  aim.hit = RayHit{{3, 11, 0}, 1, Direction::neg_x, 2.5};
  CHECK(click_of(aim).height == Approx(0.75));
  aim.hit->distance = 0;  // of a script
  CHECK(click_of(aim).height == Approx(0.5));
  aim.eye.y = 90;
  aim.hit->distance = 1;
  CHECK(click_of(aim).height == Approx(1));
}

TEST_CASE("the voxel tool places what the click means", "[tools][hands]") {
  ToolBench bench;
  bench.show_flat();
  const MaterialTable table = full_table();
  static_cast<void>(bench.box.set_materials(table));
  Aim aim = bench.aim_at({3, -1, 3}, Direction::pos_y, id_in(table, "minecraft:oak_stairs"));
  aim.look = kEast;
  const auto edits = bench.box.press(bench.replica, aim, ToolButton::place);
  REQUIRE(edits);
  bench.predict(*edits);
  CHECK(bench.at({3, 0, 3}) == id_in(table, "minecraft:oak_stairs[facing=east]"));
  // A place that is typed was not clicked.
  bench.box.type_places(TypedPlaces{ToolButton::place, {{6, 0, 6}}, Direction::pos_y});
  const auto typed = bench.box.apply_typed(bench.replica, id_in(table, "minecraft:oak_stairs"));
  REQUIRE(typed);
  bench.predict(*typed);
  CHECK(bench.at({6, 0, 6}) == id_in(table, "minecraft:oak_stairs"));
}

}  // namespace runstone::test
