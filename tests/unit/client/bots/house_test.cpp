#include "client/bots/house.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace runstone;

TEST_CASE("a house sets no voxel twice and stays on its plot", "[bots]") {
  const VoxelPos corner = {-24, 7, 36};
  const VoxelBox plot = {corner,
                         {corner.x + kPlotSide, corner.y + kHouseHeight, corner.z + kPlotSide}};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SplitMix64 random(seed);
    const HouseMaterials materials = draw_house_materials(default_material_table(), random);
    const auto plan = plan_house(corner, materials, random);
    std::set<VoxelPos> seen;
    for (const Placement& placement : plan) {
      CHECK(plot.contains(placement.at));
      CHECK(placement.material != kEmpty);
      CHECK(seen.insert(placement.at).second);
    }
    CHECK(plan.size() > 150);
  }
}

TEST_CASE("a house is built from the ground up, with windows", "[bots]") {
  SplitMix64 random(3);
  const HouseMaterials materials = draw_house_materials(default_material_table(), random);
  const auto plan = plan_house({0, 0, 0}, materials, random);
  CHECK(std::is_sorted(plan.begin(), plan.end(),
                       [](const Placement& a, const Placement& b) { return a.at.y < b.at.y; }));
  const auto windows = std::count_if(
      plan.begin(), plan.end(), [&](const Placement& p) { return p.material == materials.window; });
  CHECK(windows >= 4);
}

TEST_CASE("a table without the builders' palette still has materials for a house", "[bots]") {
  MaterialTable table;
  REQUIRE(table.add({"mud", {90, 60, 30, 255}, Visibility::opaque, std::nullopt}).has_value());
  SplitMix64 random(1);
  const HouseMaterials materials = draw_house_materials(table, random);
  for (const Material material :
       {materials.floor, materials.wall, materials.window, materials.roof, materials.foundation}) {
    CHECK(material == 1);
  }
}
