#include "common/materials/palette.hpp"

#include <catch2/catch.hpp>

#include "common/materials/material_lookup.hpp"

using namespace runstone;

namespace {

MaterialTable palette_of(const std::vector<std::string>& names) {
  MaterialTable table;
  for (const std::string& name : names) {
    MaterialInfo info;
    info.name = name;
    REQUIRE(table.add(info).has_value());
  }
  return table;
}

}  // namespace

TEST_CASE("a palette adds what a world lacks, and no id changes", "[materials]") {
  MaterialTable world = palette_of({"default:glass", "a:wool", "b:wool", "stone"});
  const MaterialTable before = world;
  const auto added = append_palette(world, palette_of({"stone", "glass", "wool", "brick"}));
  REQUIRE(added.has_value());
  CHECK(*added == 2);
  CHECK(world.size() == before.size() + 2);
  for (Material id = 0; id < before.size(); ++id) CHECK(world[id] == before[id]);
  CHECK(*find_material(world, "glass") == 1);  // the world's own
  CHECK(*find_material(world, "wool") == 5);   // before, the name was ambiguous
  CHECK(*find_material(world, "brick") == 6);
  CHECK(*append_palette(world, palette_of({"stone", "glass", "wool", "brick"})) == 0);
}

TEST_CASE("a palette that does not fit adds nothing", "[materials]") {
  MaterialTable world;
  while (world.size() < kMaterialCountMax - 1) {
    MaterialInfo info;
    info.name = "m" + std::to_string(world.size());
    REQUIRE(world.add(info).has_value());
  }
  const auto added = append_palette(world, palette_of({"glass", "wool"}));
  REQUIRE_FALSE(added.has_value());
  CHECK(added.error().code == ErrorCode::limit_exceeded);
  CHECK(world.size() == kMaterialCountMax - 1);
  CHECK(*append_palette(world, palette_of({"glass"})) == 1);
  CHECK(world.size() == kMaterialCountMax);
}
