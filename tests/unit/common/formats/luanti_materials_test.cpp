#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/formats/material_match.hpp"

using namespace runstone;

namespace {

MaterialInfo material_of(std::string_view name, bool keep_all) {
  return material_of_luanti_node({std::string(name), ""}, keep_all);
}

Visibility visibility_of(std::string_view name, bool keep_all = false) {
  return material_of(name, keep_all).visibility;
}

}  // namespace

TEST_CASE("air and nodes that are not generated are air", "[formats]") {
  for (const bool keep_all : {false, true}) {
    CHECK(material_of("air", keep_all) == MaterialTable()[kEmpty]);
    CHECK(material_of("ignore", keep_all) == MaterialTable()[kEmpty]);
  }
}

TEST_CASE("ground is opaque, water and glass are transparent, plants have a shape", "[formats]") {
  CHECK(visibility_of("default:stone") == Visibility::opaque);
  CHECK(visibility_of("default:acacia_leaves") == Visibility::opaque);
  CHECK(visibility_of("default:sand_with_kelp") == Visibility::opaque);
  CHECK(visibility_of("default:water_source") == Visibility::transparent);
  CHECK(visibility_of("default:glass") == Visibility::transparent);
  CHECK(material_of("default:water_flowing", false).body == MaterialBody::liquid);
  CHECK(material_of("default:lava_source", false).body == MaterialBody::liquid);
  CHECK(material_of("default:glass", false).body == MaterialBody::solid);
  CHECK(material_of("default:grass_3", true).body == MaterialBody::passable);
  for (const char* plant :
       {"default:grass_3", "default:torch_wall", "flowers:some_new_flower", "farming:wheat_5"}) {
    CAPTURE(plant);
    const MaterialInfo info = material_of(plant, false);
    CHECK(info.visibility == Visibility::opaque);
    CHECK(info.body == MaterialBody::passable);
    CHECK_FALSE(info.shape.is_cube());
    CHECK(material_of(plant, true) == info);
  }
  CHECK(visibility_of("farming:straw") == Visibility::opaque);
  CHECK(visibility_of("othermod:marble") == Visibility::opaque);
}

TEST_CASE("a param2 that says how a shape lies is a part of the name", "[formats]") {
  const auto with = [](const char* name, const char* states) {
    return material_of_luanti_node({name, states}, false);
  };
  const MaterialInfo turned = with("stairs:stair_wood", "param2=3");
  CHECK(turned.name == "stairs:stair_wood[param2=3]");
  CHECK(turned.shape != with("stairs:stair_wood", "").shape);
  CHECK_FALSE(turned.shape.is_cube());
  CHECK(with("stairs:stair_wood", "").name == "stairs:stair_wood");
  CHECK(with("default:stone", "param2=3").name == "default:stone");
  const std::string longest = "stairs:stair_" + std::string(kMaterialNameBytesMax - 13, 'a');
  CHECK(with(longest.c_str(), "param2=3").name == longest);
}

TEST_CASE("stairs and walls have the colour of their material", "[formats]") {
  const auto colour = [](std::string_view name) { return material_of(name, false).colour; };
  CHECK(colour("stairs:stair_cobble") == colour("default:cobble"));
  CHECK(colour("stairs:stair_inner_brick") == colour("default:brick"));
  CHECK(colour("stairs:slab_wood") == colour("default:wood"));
  CHECK(colour("walls:mossycobble") == colour("default:mossycobble"));
}

TEST_CASE("nodes have the look that belongs to their name", "[formats]") {
  const auto look = [](std::string_view name) {
    const auto given = material_of(name, true).look;
    REQUIRE(given.has_value());
    return *given;
  };
  CHECK(look("default:acacia_wood").pattern == MaterialPattern::planks);
  CHECK(look("default:meselamp").emission == 100);
  CHECK(look("default:torch").emission == 100);
  CHECK(look("default:lava_source").emission > 0);
  CHECK(look("default:ice").roughness < look("default:stone").roughness);
  // Grass on earth is a cube, and a tuft of grass is two planes.
  CHECK(look("default:grass_3").pattern == MaterialPattern::blades);
  CHECK(look("default:dirt_with_grass").pattern == MaterialPattern::none);
  CHECK(look("mod:grassy_block").pattern == MaterialPattern::none);
}

TEST_CASE("unknown names get a shade of the colour of their kind", "[formats]") {
  const auto a = material_of("mod:oak_leaves", false), b = material_of("mod:fir_leaves", false);
  CHECK(a.colour != b.colour);
  for (const auto& leaves : {a, b}) {
    CHECK(leaves.colour[1] > leaves.colour[0]);
    CHECK(leaves.colour[1] > leaves.colour[2]);
  }
  // Pinned: colours are stored in worlds, so they must not depend on compiler or run.
  const auto colour = material_of("mod:xyzzy", false).colour;
  const std::array<int, 4> pinned{colour[0], colour[1], colour[2], colour[3]};
  CHECK(pinned == std::array<int, 4>{140, 201, 113, 255});
}

TEST_CASE("the param2 of a node of a world stays in its name if it is a direction or a colour",
          "[formats]") {
  const auto name_of = [](std::string_view name, const char* states, bool keep_all = false) {
    return material_of_luanti_world_node({std::string(name), states}, keep_all).name;
  };
  CHECK(name_of("stairs:stair_cobble", "param2=3") == "stairs:stair_cobble[param2=3]");
  CHECK(name_of("stairs:stair_cobble", "") == "stairs:stair_cobble");
  CHECK(name_of("default:chest", "param2=23") == "default:chest[param2=23]");
  CHECK(name_of("default:acacia_tree", "param2=255") == "default:acacia_tree[param2=255]");
  CHECK(name_of("runstone:red__bricks", "param2=3") == "red bricks[param2=3]");
  CHECK(name_of("stairs:stair_leaves", "param2=1") == "stairs:stair_leaves[param2=1]");
  CHECK(name_of("default:torch", "param2=1") == "default:torch[param2=1]");
  for (const char* name :
       {"default:water_flowing", "default:lava_flowing", "default:leaves", "default:pine_needles",
        "default:blueberry_bush_leaves_with_berries", "default:sand_with_kelp"})
    CHECK(name_of(name, "param2=7") == name);
  CHECK(name_of("air", "param2=7") == "air");
  // The names of a build that is placed are the same.
  CHECK(world_name_of({{"default:chest"}, "param2=3"}) == "default:chest[param2=3]");
  const MaterialInfo one =
      material_of_luanti_world_node({"stairs:stair_cobble", "param2=3"}, false);
  CHECK(one.colour == material_of("stairs:stair_cobble", false).colour);
  CHECK(one.look == material_of("stairs:stair_cobble", false).look);
}

TEST_CASE("every name becomes a row that a table accepts", "[formats]") {
  SplitMix64 random(Catch::rngSeed());
  MaterialTable table;
  for (int i = 0; i < 500; ++i) {
    std::string name;
    const std::uint32_t size = random.below(150);
    for (std::uint32_t k = 0; k < size; ++k) name += static_cast<char>(random.below(256));
    if (i % 2 == 0) name = "mod:" + std::string(random.below(100), 'a') + std::to_string(i);
    CAPTURE(name);
    const MaterialInfo info = material_of(name, random.below(2) == 0);
    CHECK(info == material_of(name, info.visibility == Visibility::transparent));
    if (!table.find(info.name)) REQUIRE(table.add(info).has_value());
  }
  CHECK(table.size() > 400);
  CHECK(material_of(std::string(65, 'a'), false).name !=
        material_of(std::string(66, 'a'), false).name);
  CHECK(material_of("default:stone", false).name == "default:stone");
}
