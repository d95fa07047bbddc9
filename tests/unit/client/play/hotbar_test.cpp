#include "client/play/hotbar.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

#include "common/materials/material_lookup.hpp"
#include "common/materials/palette.hpp"

using namespace runstone;

namespace {

struct HotbarBench {
  Player player;
  Hotbar bar{player};
};

Material add(MaterialTable& table, const char* name, Visibility visibility, MaterialBody body) {
  const auto alpha = static_cast<std::uint8_t>(visibility == Visibility::opaque ? 255 : 128);
  const auto id = table.add({name, {90, 90, 90, alpha}, visibility, {}, body});
  REQUIRE(id.has_value());
  return *id;
}

}  // namespace

TEST_CASE_METHOD(HotbarBench, "the hotbar of the built-in table has nine different blocks",
                 "[client_app]") {
  const MaterialTable& table = default_material_table();
  bar.fill(table);
  CHECK(table[bar.slots()[0]].name == "stone");
  std::set<Material> seen;
  for (const Material material : bar.slots()) {
    CHECK(seen.insert(material).second);
    CHECK(table[material].body == MaterialBody::solid);
  }
}

TEST_CASE_METHOD(HotbarBench, "the hotbar of an imported world begins with blocks, not with plants",
                 "[client_app]") {
  MaterialTable table;
  add(table, "default:acacia_bush_leaves", Visibility::transparent, MaterialBody::solid);
  add(table, "default:grass_1", Visibility::transparent, MaterialBody::passable);
  add(table, "default:water_source", Visibility::transparent, MaterialBody::liquid);
  const Material obsidian = add(table, "default:obsidian", Visibility::opaque, MaterialBody::solid);
  const Material stone = add(table, "default:stone", Visibility::opaque, MaterialBody::solid);
  bar.fill(table);
  CHECK(bar.slots()[0] == stone);
  CHECK(bar.slots()[1] == obsidian);
  CHECK(bar.slots()[2] == 1);       // the leaves, which are solid, come last
  CHECK(bar.slots()[3] == kEmpty);  // neither plants nor water
}

TEST_CASE_METHOD(
    HotbarBench,
    "the hotbar of an imported world has the world's own materials, and built-in ones that it lacks",
    "[client_app]") {
  MaterialTable table;
  for (const char* name : {"default:acacia_wood", "default:dirt", "default:dirt_with_grass",
                           "default:stone", "default:tree", "default:wood"})
    add(table, name, Visibility::opaque, MaterialBody::solid);
  REQUIRE(append_palette(table, default_material_table()).has_value());
  bar.fill(table);
  std::vector<std::string> names;
  for (const Material material : bar.slots()) names.push_back(table[material].name);
  CHECK(names == std::vector<std::string>{"default:stone", "default:dirt_with_grass",
                                          "default:dirt", "default:wood", "brick", "stone_brick",
                                          "glass", "default:tree", "lamp"});
}

TEST_CASE_METHOD(HotbarBench,
                 "the wheel goes round the slots, and a material takes the chosen slot once",
                 "[client_app]") {
  bar.fill(default_material_table());
  bar.scroll(1);
  CHECK(bar.slot() == 8);
  bar.scroll(-2);
  CHECK(bar.slot() == 1);
  const Material gold = *find_material(default_material_table(), "gold");
  bar.hold(gold, 0);
  CHECK(bar.slot() == 1);
  CHECK(player.held() == gold);
  bar.choose(4);
  bar.hold(gold, 0);  // slot 1 has it
  CHECK(bar.slot() == 1);
}

TEST_CASE_METHOD(HotbarBench, "materials that are picked one after another take one slot each",
                 "[client_app]") {
  const MaterialTable& table = default_material_table();
  bar.fill(table);
  std::vector<Material> others;
  for (Material id = 1; others.size() < kSlotCount + 1; ++id) {
    if (std::find(bar.slots().begin(), bar.slots().end(), id) == bar.slots().end())
      others.push_back(id);
  }
  bar.choose(7);
  const Material eighth = bar.slots()[8];
  bar.pick(others[0], 1'000'000);
  CHECK(bar.slot() == 7);
  bar.pick(others[1], 2'000'000);
  CHECK(bar.slot() == 8);
  CHECK(bar.slots()[8] != eighth);
  bar.pick(others[2], 3'000'000);
  CHECK(bar.slot() == 0);
  bar.pick(others[0], 3'100'000);  // a slot has it
  CHECK(bar.slot() == 7);
  CHECK(player.held() == others[0]);
  bar.pick(others[3], 1'000'000 + Hotbar::kFreshUs);  // the slot is not fresh any more
  CHECK(bar.slot() == 7);
  CHECK(bar.slots()[8] == others[1]);
  bar.hold(others[4], 4'100'000);  // a choice is for the chosen slot
  CHECK(bar.slot() == 7);
  for (std::size_t i = 5; i < others.size(); ++i) bar.pick(others[i], 4'200'000);
  CHECK(bar.slots()[7] == others[4]);
}

TEST_CASE_METHOD(HotbarBench, "a player holds the material of the chosen slot", "[client]") {
  bar.fill(default_material_table());
  CHECK(player.held() == bar.slots()[0]);
  CHECK(bar.act(Action::hold_slot_3));
  CHECK(player.held() == bar.slots()[2]);
  CHECK_FALSE(bar.act(Action::undo));
  bar.scroll(1);
  CHECK(player.held() == bar.slots()[1]);
  bar.choose(kSlotCount);  // there is no such slot
  CHECK(bar.slot() == 1);
  const Material stone = bar.slots()[0];
  bar.hold(stone, 0);
  CHECK(bar.slot() == 0);
  CHECK(player.held() == stone);
}

TEST_CASE_METHOD(HotbarBench, "a player never holds an empty slot", "[client]") {
  MaterialTable table;  // a world with one block fills one slot
  const auto block =
      table.add({"block", {90, 90, 90, 255}, Visibility::opaque, {}, MaterialBody::solid});
  REQUIRE(block.has_value());
  bar.fill(table);
  REQUIRE(player.held() == *block);
  bar.choose(5);
  CHECK(player.held() == *block);
  bar.hold(kEmpty, 0);
  CHECK(player.held() == *block);
  CHECK(bar.slots()[5] == kEmpty);
}
