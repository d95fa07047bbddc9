#include "common/formats/shape_names.hpp"

#include <catch2/catch.hpp>

#include "common/formats/luanti_block.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone::test {
namespace {

std::vector<ShapeBox> boxes_by_name(std::string_view name) {
  const auto shape = shape_of_material_name(name);
  return shape ? shape->boxes : std::vector<ShapeBox>{};
}

using NodeBoxes = std::vector<ShapeBox>;
constexpr ShapeBox kBottom{{0, 0, 0}, {16, 8, 16}}, kTop{{0, 8, 0}, {16, 16, 16}};

}  // namespace

TEST_CASE("nodes of Luanti turn with their facedir", "[formats][shapes]") {
  CHECK(boxes_by_name("stairs:slab_wood") == NodeBoxes{kBottom});
  CHECK(boxes_by_name("stairs:slab_wood[param2=3]") == NodeBoxes{kBottom});
  CHECK(boxes_by_name("stairs:slab_wood[param2=20]") == NodeBoxes{kTop});
  CHECK(boxes_by_name("stairs:slab_wood[param2=22]") == NodeBoxes{kTop});
  // The top of a node points to +z, -z, +x and -x.
  CHECK(boxes_by_name("stairs:slab_wood[param2=4]") == NodeBoxes{{{0, 0, 0}, {16, 16, 8}}});
  CHECK(boxes_by_name("stairs:slab_wood[param2=8]") == NodeBoxes{{{0, 0, 8}, {16, 16, 16}}});
  CHECK(boxes_by_name("stairs:slab_wood[param2=12]") == NodeBoxes{{{0, 0, 0}, {8, 16, 16}}});
  CHECK(boxes_by_name("stairs:slab_wood[param2=17]") == NodeBoxes{{{8, 0, 0}, {16, 16, 16}}});
  // Stairs rise towards +z, +x, -z and -x.
  CHECK(boxes_by_name("stairs:stair_stone") == NodeBoxes{kBottom, {{0, 8, 8}, {16, 16, 16}}});
  CHECK(boxes_by_name("stairs:stair_stone[param2=1]") ==
        NodeBoxes{kBottom, {{8, 8, 0}, {16, 16, 16}}});
  CHECK(boxes_by_name("stairs:stair_stone[param2=2]") ==
        NodeBoxes{kBottom, {{0, 8, 0}, {16, 16, 8}}});
  CHECK(boxes_by_name("moreblocks:stair_stone[param2=35]") ==
        NodeBoxes{kBottom, {{0, 8, 0}, {8, 16, 16}}});
  CHECK(boxes_by_name("stairs:stair_outer_stone") == NodeBoxes{kBottom, {{0, 8, 8}, {8, 16, 16}}});
  CHECK(boxes_by_name("stairs:stair_inner_stone").size() == 3);
}

TEST_CASE("slabs and stairs whose form stands at the end of their name", "[formats][shapes]") {
  CHECK(boxes_by_name("mcl_stairs:slab_stone") == NodeBoxes{kBottom});
  CHECK(boxes_by_name("mcl_stairs:slab_stone_top") == NodeBoxes{kTop});
  CHECK_FALSE(shape_of_material_name("mcl_stairs:slab_stone_double"));
  CHECK(boxes_by_name("mcl_stairs:stair_wood_inner[param2=1]") ==
        boxes_by_name("stairs:stair_inner_wood[param2=1]"));
  CHECK(boxes_by_name("mcl_stairs:stair_wood_outer[param2=1]") ==
        boxes_by_name("stairs:stair_outer_wood[param2=1]"));
}

TEST_CASE("other nodes of Luanti have their shapes", "[formats][shapes]") {
  CHECK(boxes_by_name("default:ladder_wood[param2=2]") == NodeBoxes{{{15, 0, 0}, {16, 16, 16}}});
  CHECK(boxes_by_name("default:ladder_wood[param2=3]") == NodeBoxes{{{0, 0, 0}, {1, 16, 16}}});
  CHECK(boxes_by_name("default:ladder_wood[param2=5]") == NodeBoxes{{{0, 0, 0}, {16, 16, 1}}});
  CHECK(boxes_by_name("default:ladder_wood[param2=1]") == NodeBoxes{{{0, 0, 0}, {16, 1, 16}}});
  CHECK(boxes_by_name("default:ladder_wood") == NodeBoxes{{{0, 15, 0}, {16, 16, 16}}});
  CHECK(boxes_by_name("xpanes:pane_flat[param2=1]") == NodeBoxes{{{7, 0, 0}, {9, 16, 16}}});
  CHECK(boxes_by_name("default:torch") == NodeBoxes{{{7, 0, 7}, {9, 10, 9}}});
  CHECK(boxes_by_name("default:fence_wood") == NodeBoxes{{{6, 0, 6}, {10, 16, 10}}});
  CHECK(boxes_by_name("doors:door_wood_a[param2=2]") == NodeBoxes{{{0, 0, 14}, {16, 16, 16}}});
  CHECK(boxes_by_name("doors:trapdoor") == NodeBoxes{{{0, 0, 0}, {16, 2, 16}}});
  CHECK(boxes_by_name("xpanes:door_steel_bar_a[param2=2]") ==
        boxes_by_name("doors:door_wood_a[param2=2]"));
  CHECK(boxes_by_name("xpanes:trapdoor_steel_bar") == boxes_by_name("doors:trapdoor"));
  CHECK(boxes_by_name("xpanes:trapdoor_steel_bar_open") == boxes_by_name("doors:trapdoor_open"));
  for (const char* name :
       {"flowers:rose", "default:grass_3", "default:papyrus", "farming:wheat_8"}) {
    CAPTURE(name);
    REQUIRE(shape_of_material_name(name));
    CHECK(shape_of_material_name(name)->form == ShapeForm::crossed);
  }
  for (const char* name :
       {"default:stone", "default:cactus", "default:snowblock", "wool:red", "default:chest",
        "default:wood", "default:leaves", "snow", "torch", "oak_stairs", "air", "", ":",
        "minecraft:stone", "minecraft:", "a:b[", "a:b[]"}) {
    CAPTURE(name);
    CHECK_FALSE(shape_of_material_name(name));
  }
}

TEST_CASE("names of Minecraft's materials have the shape of their block", "[formats][shapes]") {
  CHECK(boxes_by_name("minecraft:oak_stairs[facing=east]") ==
        NodeBoxes{kBottom, {{8, 8, 0}, {16, 16, 16}}});
  CHECK(boxes_by_name("minecraft:oak_slab[type=top]") == NodeBoxes{kTop});
  CHECK(boxes_by_name("mod:fir_slab") == NodeBoxes{kBottom});
  CHECK_FALSE(shape_of_material_name("minecraft:oak_slab[type=double]"));
  CHECK_FALSE(shape_of_material_name("minecraft:oak_slab[type=bottom]"));  // not its name
}

TEST_CASE("an imported node has the shape that its name in the world says", "[formats][shapes]") {
  for (const char* node :
       {"mcl_core:ladder", "mcl_torches:torch", "mcl_chests:chest", "stairs:stair_wood",
        "default:torch_wall", "mcl_fences:oak_fence", "default:stone", "mcl_core:stone"}) {
    for (const char* states : {"", "param2=3", "param2=255"}) {
      const MaterialInfo info = material_of_luanti_world_node({node, states}, true);
      CAPTURE(info.name);
      CHECK(info.shape == shape_of_material_name(info.name).value_or(Shape{}));
    }
  }
  CHECK(shape_of_material_name("mcl_core:ladder[param2=3]"));
}

TEST_CASE("every param2 gives a shape that a material may have", "[formats][shapes]") {
  for (const char* node : {"stairs:stair_inner_a", "default:torch_wall", "doors:gate_wood_open",
                           "beds:bed_bottom", "default:sign_wall_wood", "flowers:rose"}) {
    for (int param2 = 0; param2 < 256; ++param2) {
      const auto shape =
          shape_of_material_name(std::string(node) + "[param2=" + std::to_string(param2) + "]");
      CAPTURE(node, param2);
      REQUIRE(shape);
      CHECK(check_shape(*shape));
    }
  }
}

}  // namespace runstone::test
