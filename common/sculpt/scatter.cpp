#include "common/sculpt/scatter.hpp"

#include "common/core/hash.hpp"
#include "common/sculpt/brush_weights.hpp"
#include "common/sculpt/terrain_brush.hpp"

namespace runstone {
namespace {

std::uint64_t hash_of_cell(std::uint64_t seed, std::int32_t x, std::int32_t z) {
  const std::uint64_t cell =
      (std::uint64_t{static_cast<std::uint32_t>(x)} << 32) | static_cast<std::uint32_t>(z);
  return mix64(mix64(seed) ^ cell);
}

}  // namespace

VoxelBox scatter_box(const Scattering& scattering, std::span<const VoxelPos> places) {
  TerrainBrush brush;
  brush.radius = scattering.radius;
  return brush_box(brush, places);
}

std::vector<ScatteredSpot> scattered_spots(const GroundColumns& columns,
                                           const GroundMaterials& materials,
                                           const Scattering& scattering,
                                           std::span<const VoxelPos> places) {
  const VoxelBox& box = columns.box();
  const auto surface = surface_heights(columns, materials);
  const auto weights = brush_weights(box, places, scattering.radius, BrushFalloff::none);
  // A place lies in the first `spacing` columns of its cell along both axes, so two places are more
  // than the other half of a cell apart.
  const std::int32_t cell = 2 * scattering.spacing;
  std::vector<ScatteredSpot> out;
  for (std::int32_t cx = floor_div(box.min.x, cell); cx * cell < box.max.x; ++cx) {
    for (std::int32_t cz = floor_div(box.min.z, cell); cz * cell < box.max.z; ++cz) {
      SplitMix64 random(hash_of_cell(scattering.seed, cx, cz));
      const auto side = static_cast<std::uint32_t>(scattering.spacing);
      const std::int32_t x = cx * cell + static_cast<std::int32_t>(random.below(side));
      const std::int32_t z = cz * cell + static_cast<std::int32_t>(random.below(side));
      const auto quarters = static_cast<std::uint8_t>(random.below(4));
      if (x < box.min.x || x >= box.max.x || z < box.min.z || z >= box.max.z) continue;
      const std::size_t i = columns.index(x, z);
      if (weights[i] == 0 || surface[i] == kNoSurface) continue;
      const Material above = material_in_column(columns.column(i), surface[i] + 1);
      if (above != kEmpty) continue;
      out.push_back({{x, surface[i], z}, quarters});
      if (out.size() > kScatteredMax) return out;
    }
  }
  return out;
}

}  // namespace runstone
