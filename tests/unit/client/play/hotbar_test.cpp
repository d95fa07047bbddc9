#include "client/play/hotbar.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

#include "common/materials/material_lookup.hpp"
#include "common/materials/palette.hpp"

using namespace runstone;

namespace {

Material add(MaterialTable& table, const char* name, Visibility visibility, MaterialBody body) {
  const auto alpha = static_cast<std::uint8_t>(visibility == Visibility::opaque ? 255 : 128);
  const auto id = table.add({name, {90, 90, 90, alpha}, visibility, {}, body});
  REQUIRE(id.has_value());
  return *id;
}

}  // namespace

TEST_CASE("the hotbar of the built-in table has nine different blocks", "[client_app]") {
  Hotbar bar;
  const MaterialTable& table = default_material_table();
  bar.fill(table);
  CHECK(table[bar.slots()[0]].name == "stone");
  std::set<Material> seen;
  for (const Material material : bar.slots()) {
    CHECK(seen.insert(material).second);
    CHECK(table[material].body == MaterialBody::solid);
  }
}

TEST_CASE("the hotbar of an imported world begins with blocks, not with plants", "[client_app]") {
  MaterialTable table;
  add(table, "default:acacia_bush_leaves", Visibility::transparent, MaterialBody::solid);
  add(table, "default:grass_1", Visibility::transparent, MaterialBody::passable);
  add(table, "default:water_source", Visibility::transparent, MaterialBody::liquid);
  const Material obsidian = add(table, "default:obsidian", Visibility::opaque, MaterialBody::solid);
  const Material stone = add(table, "default:stone", Visibility::opaque, MaterialBody::solid);
  Hotbar bar;
  bar.fill(table);
  CHECK(bar.slots()[0] == stone);
  CHECK(bar.slots()[1] == obsidian);
  CHECK(bar.slots()[2] == 1);       // the leaves, which are solid, come last
  CHECK(bar.slots()[3] == kEmpty);  // neither plants nor water
}

TEST_CASE(
    "the hotbar of an imported world has the world's own materials, and built-in ones that it lacks",
    "[client_app]") {
  MaterialTable table;
  for (const char* name : {"default:acacia_wood", "default:dirt", "default:dirt_with_grass",
                           "default:stone", "default:tree", "default:wood"})
    add(table, name, Visibility::opaque, MaterialBody::solid);
  REQUIRE(append_palette(table, default_material_table()).has_value());
  Hotbar bar;
  bar.fill(table);
  std::vector<std::string> names;
  for (const Material material : bar.slots()) names.push_back(table[material].name);
  CHECK(names == std::vector<std::string>{"default:stone", "default:dirt_with_grass",
                                          "default:dirt", "default:wood", "brick", "stone_brick",
                                          "glass", "default:tree", "lamp"});
}

TEST_CASE("the wheel goes round the slots, and a material takes the chosen slot once",
          "[client_app]") {
  Hotbar bar;
  bar.fill(default_material_table());
  bar.scroll(1);
  CHECK(bar.slot() == 8);
  bar.scroll(-2);
  CHECK(bar.slot() == 1);
  const Material gold = *find_material(default_material_table(), "gold");
  bar.hold(gold);
  CHECK(bar.slot() == 1);
  CHECK(bar.held() == gold);
  bar.choose(4);
  bar.hold(gold);  // slot 1 has it
  CHECK(bar.slot() == 1);
}
