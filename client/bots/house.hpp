// House: what builders build: a small house, voxel by voxel in the order in which a person would
// set them. First the floor, then the walls with a door and windows from the ground up, then a
// stepped roof.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

inline constexpr std::int32_t kPlotSide = 12;     // voxels; a house leaves a path around it
inline constexpr std::int32_t kHouseHeight = 10;  // voxels above its floor at most

struct HouseMaterials {
  Material floor = 1, wall = 1, window = 1, roof = 1, foundation = 1;
};
/// Draws materials from the builders' palette of the table, or from all its materials if it has no
/// such palette. Requires a table with a material that is not empty.
HouseMaterials draw_house_materials(const MaterialTable& table, SplitMix64& random);

struct Placement {
  VoxelPos at;
  Material material = kEmpty;
  friend bool operator==(const Placement&, const Placement&) = default;
};

/// Plans a house. `corner`: the corner of smallest x and z of the plot, at the height of the floor.
/// Returns no voxel twice, and only voxels within the plot and below corner.y + kHouseHeight.
std::vector<Placement> plan_house(VoxelPos corner, const HouseMaterials& materials,
                                  SplitMix64& random);

}  // namespace runstone
