#include "client/bots/house.hpp"

#include <array>
#include <span>
#include <string_view>

namespace runstone {
namespace {

using Names = std::span<const std::string_view>;
constexpr std::array<std::string_view, 4> kFloors = {"planks", "stone", "marble", "wool_brown"};
constexpr std::array<std::string_view, 8> kWalls = {"brick",     "stone_brick", "marble",
                                                    "sandstone", "planks",      "wool_white",
                                                    "wool_cyan", "wool_yellow"};
constexpr std::array<std::string_view, 1> kWindows = {"glass"};
constexpr std::array<std::string_view, 6> kRoofs = {"slate",    "thatch", "copper",
                                                    "wool_red", "log",    "wool_blue"};
constexpr std::array<std::string_view, 2> kFoundations = {"cobble", "stone"};

Material draw(const MaterialTable& table, Names names, SplitMix64& random) {
  const std::string_view name = names[random.below(static_cast<std::uint32_t>(names.size()))];
  if (const auto found = table.find(name)) return *found;
  return static_cast<Material>(1 + random.below(static_cast<std::uint32_t>(table.size() - 1)));
}

}  // namespace

HouseMaterials draw_house_materials(const MaterialTable& table, SplitMix64& random) {
  HouseMaterials out;
  out.floor = draw(table, kFloors, random);
  out.wall = draw(table, kWalls, random);
  out.window = draw(table, kWindows, random);
  out.roof = draw(table, kRoofs, random);
  out.foundation = draw(table, kFoundations, random);
  return out;
}

std::vector<Placement> plan_house(VoxelPos corner, const HouseMaterials& materials,
                                  SplitMix64& random) {
  const std::int32_t width = random.between(7, 9), depth = random.between(7, 9);
  const std::int32_t walls = random.between(3, 4);
  const VoxelPos first = {corner.x + (kPlotSide - width) / 2, corner.y,
                          corner.z + (kPlotSide - depth) / 2};
  const std::int32_t door = random.between(2, width - 3);
  std::vector<Placement> plan;
  const auto set = [&](std::int32_t x, std::int32_t y, std::int32_t z, Material material) {
    plan.push_back({{first.x + x, first.y + y, first.z + z}, material});
  };

  for (std::int32_t z = 0; z < depth; ++z) {
    for (std::int32_t x = 0; x < width; ++x) set(x, 0, z, materials.floor);
  }
  for (std::int32_t y = 1; y <= walls; ++y) {
    const auto wall = [&](std::int32_t x, std::int32_t z, std::int32_t along, std::int32_t length) {
      const bool is_window = y == 2 && along % 3 == 2 && along < length - 1;
      set(x, y, z, is_window ? materials.window : materials.wall);
    };
    for (std::int32_t x = 0; x < width; ++x) {
      if (x != door || y > 2) wall(x, 0, x, width);
    }
    for (std::int32_t z = 1; z < depth; ++z) wall(width - 1, z, z, depth);
    for (std::int32_t x = width - 2; x >= 0; --x) wall(x, depth - 1, x, width);
    for (std::int32_t z = depth - 2; z >= 1; --z) wall(0, z, z, depth);
  }
  // Each step of the roof is a frame, one voxel further inside. The eaves are one voxel outside.
  for (std::int32_t step = -1; 2 * step < width && 2 * step < depth; ++step) {
    const std::int32_t y = walls + 2 + step;
    if (y >= kHouseHeight) break;
    const std::int32_t x_last = width - 1 - step, z_last = depth - 1 - step;
    if (x_last < step || z_last < step) break;
    for (std::int32_t z = step; z <= z_last; ++z) {
      for (std::int32_t x = step; x <= x_last; ++x) {
        if (x == step || x == x_last || z == step || z == z_last) set(x, y, z, materials.roof);
      }
    }
  }
  return plan;
}

}  // namespace runstone
