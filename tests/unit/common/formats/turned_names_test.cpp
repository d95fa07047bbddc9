#include "common/formats/turned_names.hpp"

#include <catch2/catch.hpp>

#include "common/formats/shape_names.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone::test {
namespace {

constexpr std::array kStraight = {Axis::x, Axis::y, Axis::z};
constexpr std::array kSwapped = {Axis::z, Axis::y, Axis::x};

/// North goes to east.
std::string quarter(std::string_view name) {
  return turned_material_name(name, kSwapped, 1).value_or("none");
}
std::string mirrored_x(std::string_view name) {
  return turned_material_name(name, kStraight, 1).value_or("none");
}
std::string upside_down_name(std::string_view name) {
  return turned_material_name(name, kStraight, 2).value_or("none");
}

}  // namespace

TEST_CASE("a quarter turn changes where blocks face", "[formats][shapes]") {
  CHECK(quarter("minecraft:oak_stairs") == "minecraft:oak_stairs[facing=east]");
  CHECK(quarter("minecraft:oak_stairs[facing=west,half=top]") == "minecraft:oak_stairs[half=top]");
  CHECK(quarter("minecraft:oak_log[axis=x]") == "minecraft:oak_log[axis=z]");
  CHECK(quarter("minecraft:oak_log") == "minecraft:oak_log");
  CHECK(quarter("minecraft:oak_sign[rotation=13]") == "minecraft:oak_sign[rotation=1]");
  CHECK(quarter("minecraft:oak_fence[north=true,west=true]") ==
        "minecraft:oak_fence[east=true,north=true]");
  CHECK(quarter("minecraft:cobblestone_wall[east=tall,north=low]") ==
        "minecraft:cobblestone_wall[east=low,south=tall]");
  CHECK(quarter("minecraft:rail") == "minecraft:rail[shape=east_west]");
  CHECK(quarter("minecraft:rail[shape=south_east]") == "minecraft:rail[shape=south_west]");
  CHECK(quarter("minecraft:rail[shape=ascending_west]") == "minecraft:rail[shape=ascending_north]");
  CHECK(quarter("minecraft:oak_door[facing=east,hinge=right]") ==
        "minecraft:oak_door[facing=south,hinge=right]");
  CHECK(quarter("minecraft:jigsaw") == "minecraft:jigsaw[orientation=east_up]");
  CHECK(quarter("minecraft:furnace[facing=south,lit=true]") ==
        "minecraft:furnace[facing=west,lit=true]");
  CHECK(quarter("minecraft:stone") == "minecraft:stone");
  CHECK(quarter("air") == "air");
}

TEST_CASE("a mirror swaps left and right", "[formats][shapes]") {
  CHECK(mirrored_x("minecraft:oak_stairs[facing=east,shape=inner_left]") ==
        "minecraft:oak_stairs[facing=west,shape=inner_right]");
  CHECK(mirrored_x("minecraft:oak_door") == "minecraft:oak_door[hinge=right]");
  CHECK(mirrored_x("minecraft:chest[type=left]") == "minecraft:chest[type=right]");
  CHECK(mirrored_x("minecraft:oak_sign[rotation=3]") == "minecraft:oak_sign[rotation=13]");
  CHECK(turned_material_name("minecraft:oak_sign[rotation=3]", kStraight, 4) ==
        "minecraft:oak_sign[rotation=5]");
  CHECK(mirrored_x("minecraft:rail[shape=north_east]") == "minecraft:rail[shape=north_west]");
}

TEST_CASE("blocks lie upside down only if they have such a state", "[formats][shapes]") {
  CHECK(upside_down_name("minecraft:oak_stairs") == "minecraft:oak_stairs[half=top]");
  CHECK(upside_down_name("minecraft:oak_slab[type=top]") == "minecraft:oak_slab");
  CHECK(upside_down_name("minecraft:oak_trapdoor") == "minecraft:oak_trapdoor[half=top]");
  CHECK(upside_down_name("minecraft:stone_button[face=floor]") ==
        "minecraft:stone_button[face=ceiling]");
  CHECK(upside_down_name("minecraft:torch") == "none");
  CHECK(upside_down_name("minecraft:poppy") == "none");
  CHECK(upside_down_name("minecraft:barrel[facing=up]") == "minecraft:barrel[facing=down]");
  CHECK(upside_down_name("minecraft:stone") == "minecraft:stone");
  // +y lies along z.
  const std::array tilted = {Axis::x, Axis::z, Axis::y};
  CHECK(turned_material_name("minecraft:oak_log", tilted, 4) == "minecraft:oak_log[axis=z]");
  CHECK(turned_material_name("minecraft:end_rod", tilted, 4) == "minecraft:end_rod[facing=north]");
  CHECK_FALSE(turned_material_name("minecraft:oak_slab", tilted, 4));
  CHECK_FALSE(turned_material_name("minecraft:furnace", tilted, 0));
  CHECK(turned_material_name("minecraft:oak_stairs", tilted, 4) ==
        "minecraft:oak_stairs[facing=south]");
}

TEST_CASE("nodes of Luanti get another param2", "[formats][shapes]") {
  CHECK(quarter("stairs:stair_wood") == "stairs:stair_wood[param2=3]");
  CHECK(quarter("stairs:stair_wood[param2=1]") == "stairs:stair_wood");
  CHECK(quarter("stairs:slab_wood[param2=1]") == "stairs:slab_wood[param2=1]");
  CHECK(upside_down_name("flowers:rose") == "none");
  CHECK(quarter("flowers:rose") == "flowers:rose");
  CHECK(quarter("default:stone") == "default:stone");
  for (int param2 = 0; param2 < 24; ++param2) {
    for (const char* node : {"stairs:stair_a", "stairs:stair_inner_a", "stairs:stair_outer_a",
                             "stairs:slab_a", "doors:trapdoor_open", "xpanes:bar_flat"}) {
      const std::string name = std::string(node) + "[param2=" + std::to_string(param2) + "]";
      for (const auto& along : {kStraight, kSwapped, std::array{Axis::y, Axis::z, Axis::x}}) {
        for (std::uint8_t flips = 0; flips < 8; ++flips) {
          const auto after = turned_material_name(name, along, flips);
          CAPTURE(name, static_cast<int>(flips));
          REQUIRE(after);
          CHECK(look_alike(*shape_of_material_name(*after),
                           turned(*shape_of_material_name(name), along, flips)));
        }
      }
    }
  }
}

TEST_CASE("ladders of VoxeLibre hang on the wall that their param2 says", "[formats][shapes]") {
  // From the south to the west, and on to the north.
  CHECK(quarter("mcl_core:ladder[param2=4]") == "mcl_core:ladder[param2=3]");
  CHECK(quarter("mcl_core:ladder[param2=3]") == "mcl_core:ladder[param2=5]");
  CHECK(mirrored_x("mcl_core:ladder[param2=3]") == "mcl_core:ladder[param2=2]");
  CHECK(upside_down_name("mcl_core:ladder") == "mcl_core:ladder[param2=1]");
}

TEST_CASE("a node whose param2 says nothing of its shape has no name for another lie",
          "[formats][shapes]") {
  CHECK(quarter("mod:ladder[param2=3]") == "none");
  CHECK(quarter("mcl_doors:iron_door") == "none");  // not [facing=east]
  CHECK(quarter("mcl_chests:chest") == "mcl_chests:chest");
  CHECK(quarter("mod:ladder") == "mod:ladder[facing=east]");  // a block of a mod of Minecraft
  CHECK(quarter("mcl_fences:oak_fence[param2=3]") == "mcl_fences:oak_fence[param2=3]");
  CHECK(quarter("default:chest[param2=3]") == "default:chest[param2=3]");
}

TEST_CASE("other names change the states in their brackets", "[formats][shapes]") {
  CHECK(quarter("stairs[facing=north,half=top]") == "stairs[facing=east,half=top]");
  CHECK(mirrored_x("stairs[facing=west,shape=inner_left]") ==
        "stairs[facing=east,shape=inner_right]");
  CHECK(quarter("stone") == "stone");
  CHECK(quarter("stairs[facing=high]") == "none");
  CHECK(quarter("odd [name") == "odd [name");
  CHECK(quarter("odd[]") == "odd[]");
  CHECK(turned_material_name("any[half", kStraight, 0) == "any[half");
}

}  // namespace runstone::test
