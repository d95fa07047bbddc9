#include "common/formats/minecraft_shapes.hpp"

#include <catch2/catch.hpp>

#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_states.hpp"

namespace runstone::test {
namespace {

std::vector<ShapeBox> block_boxes(const std::string& name, const std::string& states = "") {
  const auto shape = shape_of_minecraft_block({name, states});
  return shape && shape->form == ShapeForm::boxes ? shape->boxes : std::vector<ShapeBox>{};
}

using BoxList = std::vector<ShapeBox>;
constexpr ShapeBox kLowerHalf{{0, 0, 0}, {16, 8, 16}}, kUpperHalf{{0, 8, 0}, {16, 16, 16}};

}  // namespace

TEST_CASE("stairs, slabs and panes have their boxes", "[formats][shapes]") {
  const std::string stairs = "minecraft:oak_stairs";
  CHECK(block_boxes(stairs) == BoxList{kLowerHalf, {{0, 8, 0}, {16, 16, 8}}});
  CHECK(block_boxes(stairs, "facing=east") == BoxList{kLowerHalf, {{8, 8, 0}, {16, 16, 16}}});
  CHECK(block_boxes(stairs, "facing=south") == BoxList{kLowerHalf, {{0, 8, 8}, {16, 16, 16}}});
  CHECK(block_boxes(stairs, "facing=west") == BoxList{kLowerHalf, {{0, 8, 0}, {8, 16, 16}}});
  CHECK(block_boxes(stairs, "facing=west,half=top,shape=inner_right") ==
        BoxList{kUpperHalf, {{0, 0, 0}, {8, 8, 16}}, {{8, 0, 0}, {16, 8, 8}}});
  CHECK(block_boxes("stone_slab") == BoxList{kLowerHalf});
  CHECK(block_boxes("minecraft:stone_slab", "type=top") == BoxList{kUpperHalf});
  CHECK_FALSE(shape_of_minecraft_block({"minecraft:stone_slab", "type=double"}));
  CHECK(block_boxes("minecraft:iron_bars", "north=true") ==
        BoxList{{{7, 0, 7}, {9, 16, 9}}, {{7, 0, 0}, {9, 16, 7}}});
  CHECK(block_boxes("minecraft:oak_fence") == BoxList{{{6, 0, 6}, {10, 16, 10}}});
  CHECK(block_boxes("minecraft:cobblestone_wall", "east=tall,up=false") ==
        BoxList{{{8, 0, 5}, {16, 16, 11}}});
  CHECK(block_boxes("minecraft:farmland") == BoxList{{{0, 0, 0}, {16, 15, 16}}});
  CHECK(block_boxes("minecraft:oak_trapdoor", "facing=east,open=true") ==
        BoxList{{{0, 0, 0}, {3, 16, 16}}});
  CHECK(block_boxes("minecraft:stone_button", "face=wall,facing=north") ==
        BoxList{{{5, 6, 14}, {11, 10, 16}}});
  CHECK(block_boxes("minecraft:chain", "axis=x") == BoxList{{{0, 7, 7}, {16, 9, 9}}});
  CHECK(block_boxes("minecraft:end_rod", "facing=east") ==
        BoxList{{{0, 6, 6}, {1, 10, 10}}, {{1, 7, 7}, {16, 9, 9}}});
  CHECK(block_boxes("minecraft:sticky_piston", "extended=true,facing=up") ==
        BoxList{{{0, 0, 0}, {16, 12, 16}}});
  CHECK(
      block_boxes("biome:fir_stairs", "facing=east,half=bottom,shape=straight,waterlogged=false") ==
      block_boxes(stairs, "facing=east"));
}

TEST_CASE("plants are crossed, and cubes and liquids have no shape", "[formats][shapes]") {
  for (const char* name :
       {"minecraft:poppy", "minecraft:red_tulip", "minecraft:short_grass", "minecraft:oak_sapling",
        "minecraft:wheat", "minecraft:fern", "minecraft:brown_mushroom", "minecraft:tube_coral",
        "minecraft:sugar_cane", "minecraft:kelp", "minecraft:weeping_vines", "minecraft:cobweb"}) {
    CAPTURE(name);
    const auto shape = shape_of_minecraft_block({name, ""});
    REQUIRE(shape);
    CHECK(shape->form == ShapeForm::crossed);
  }
  CHECK(shape_of_minecraft_block({"minecraft:wheat", "age=7"})->boxes[0].max[1] == 16);
  for (const char* name : {"minecraft:stone",
                           "minecraft:oak_leaves",
                           "minecraft:water",
                           "minecraft:lava",
                           "minecraft:air",
                           "minecraft:glass",
                           "minecraft:sea_lantern",
                           "minecraft:jack_o_lantern",
                           "minecraft:brown_mushroom_block",
                           "minecraft:tube_coral_block",
                           "minecraft:oak_log",
                           "minecraft:mangrove_roots",
                           "minecraft:chiseled_bookshelf",
                           "minecraft:bedrock",
                           "minecraft:barrier",
                           "minecraft:chain_command_block",
                           "minecraft:piston",
                           "minecraft:melon",
                           "minecraft:snow_block",
                           "minecraft:bamboo_block",
                           "minecraft:stonebrick"}) {
    CAPTURE(name);
    CHECK_FALSE(shape_of_minecraft_block({name, ""}));
  }
  CHECK_FALSE(shape_of_minecraft_block({"minecraft:snow", "layers=8"}));
}

}  // namespace runstone::test
