#include "common/materials/default_look.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

MaterialLook look(std::string_view name) { return default_look(name, MaterialBody::solid, {}); }

}  // namespace

TEST_CASE("a name without a known word gets the usual look", "[materials]") {
  CHECK(look("xyzzy") == MaterialLook{});
  CHECK(look("") == MaterialLook{});
}

TEST_CASE("names of other programs get the look of what they are", "[materials]") {
  CHECK(look("default:meselamp").emission == 100);
  CHECK(look("default:torch_wall").emission == 100);
  CHECK(look("default:stone").emission == 0);
  CHECK(look("default:acacia_wood").pattern == MaterialPattern::planks);
  CHECK(look("default:desert_stonebrick").pattern == MaterialPattern::bricks);
  CHECK(look("stairs:stair_inner_cobble").pattern == MaterialPattern::cobble);
  CHECK(look("default:jungletree").pattern == MaterialPattern::bark);
  CHECK(look("default:silver_sandstone_block").pattern == MaterialPattern::tiles);
  CHECK(look("wool:red").pattern == MaterialPattern::weave);
  CHECK(look("default:ice").roughness < 30);
  CHECK(look("default:obsidian_glass").roughness < 30);
  CHECK(look("default:goldblock").roughness < 30);
  // A specific word wins over a general one, wherever it stands.
  CHECK(look("default:dirt_with_grass") == look("default:grass"));
  CHECK(look("default:stone_with_gold") == look("default:stone"));
}

TEST_CASE("a liquid has no pattern, but may give off light", "[materials]") {
  CHECK(default_look("default:lava_source", MaterialBody::liquid, {}).emission > 0);
  CHECK(default_look("liquid_brick", MaterialBody::liquid, {}).pattern == MaterialPattern::none);
}

TEST_CASE("a look that a row gives wins over that of its name", "[materials]") {
  MaterialInfo lamp;
  lamp.name = "lamp";
  CHECK(look_of(lamp).emission == 100);
  lamp.look = MaterialLook{1, 2, 3, 0, MaterialPattern::tiles};
  CHECK(look_of(lamp) == *lamp.look);
}

TEST_CASE("every default look is valid", "[materials]") {
  for (const char* name : {"lamp", "lava", "glass", "brick", "planks", "tree", "wool", "gold"})
    CHECK(validate_look(look(name)).has_value());
}

TEST_CASE("every built-in material has a deliberate look, and only the lamp gives off light",
          "[materials]") {
  const MaterialTable& table = default_material_table();
  for (std::size_t id = 1; id < table.size(); ++id) {
    const MaterialInfo& row = table[static_cast<Material>(id)];
    CAPTURE(row.name);
    REQUIRE(row.look.has_value());
    CHECK((row.look->emission > 0) == (row.name == "lamp"));
  }
  CHECK(look_of(table[*table.find("brick")]).pattern == MaterialPattern::bricks);
  CHECK(look_of(table[*table.find("planks")]).pattern == MaterialPattern::planks);
  CHECK(look_of(table[*table.find("glass")]).roughness < look_of(table[1]).roughness);
}
