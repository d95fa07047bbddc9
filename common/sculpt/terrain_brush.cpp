#include "common/sculpt/terrain_brush.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "common/core/assert.hpp"
#include "common/generate/value_noise.hpp"
#include "common/sculpt/brush_weights.hpp"
#include "common/sculpt/height_field.hpp"

namespace runstone {
namespace {

/// The room for slopes above and below the places of a stroke.
constexpr std::int32_t kSlopeRoom = 64;

/// Returns how far beside the radius a mode reads columns.
std::int32_t margin_of(const TerrainBrush& brush) {
  return brush.mode == BrushMode::smooth ? 2 * brush.strength : 1;
}

HeightField shaped_heights(const HeightField& before, std::span<const std::int32_t> weights,
                           const VoxelBox& box, const TerrainBrush& brush,
                           std::int32_t first_height) {
  const std::int32_t sign = brush.lowers ? -1 : 1;
  switch (brush.mode) {
    case BrushMode::raise:
      return moved_by(before, weights, [&](std::size_t) { return sign * brush.strength * 1.0; });
    case BrushMode::flatten:
      return moved_to(before, weights, HeightField::uniform(before, first_height));
    case BrushMode::smooth:
      return moved_to(before, weights, mean_heights(before, brush.strength));
    case BrushMode::erode:
      return eroded(before, weights, brush.strength);
    case BrushMode::noise: {
      const ValueNoise noise(brush.seed, 1.0 / std::max(4, brush.radius));
      const auto width = static_cast<std::size_t>(before.width);
      return moved_by(before, weights, [&](std::size_t i) {
        const std::int32_t x = box.min.x + static_cast<std::int32_t>(i % width);
        const std::int32_t z = box.min.z + static_cast<std::int32_t>(i / width);
        return sign * brush.strength * noise.at(x, z);
      });
    }
    case BrushMode::naturalise:
    case BrushMode::overlay:
      break;
  }
  return before;
}

/// Returns for each of the upper layers the material that most columns of the stroke have there.
std::vector<Material> common_layers(const GroundColumns& columns,
                                    std::span<const std::int32_t> surface,
                                    std::span<const std::int32_t> weights,
                                    const GroundMaterials& materials) {
  std::vector<Material> out;
  for (std::int32_t depth = 0; depth < kSkinVoxels; ++depth) {
    std::map<Material, std::size_t> counts;
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const std::int32_t y = surface[i] - depth;
      if (weights[i] == 0 || surface[i] == kNoSurface || y < columns.box().min.y) continue;
      const Material material = material_in_column(columns.column(i), y);
      if (materials.is_ground(material)) ++counts[material];
    }
    const auto most =
        std::max_element(counts.begin(), counts.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == counts.end()) break;
    out.push_back(most->first);
  }
  return out;
}

}  // namespace

VoxelBox brush_box(const TerrainBrush& brush, std::span<const VoxelPos> places) {
  RUNSTONE_ASSERT(!places.empty());
  RUNSTONE_ASSERT(brush.radius > 0 && brush.radius <= kBrushRadiusMax);
  RUNSTONE_ASSERT(brush.strength > 0 && brush.strength <= kBrushStrengthMax);
  VoxelBox box{places.front(), places.front()};
  for (const VoxelPos& place : places) {
    box.min = {std::min(box.min.x, place.x), std::min(box.min.y, place.y),
               std::min(box.min.z, place.z)};
    box.max = {std::max(box.max.x, place.x), std::max(box.max.y, place.y),
               std::max(box.max.z, place.z)};
  }
  const std::int32_t side = brush.radius + margin_of(brush);
  const std::int32_t up = kSlopeRoom + brush.strength;
  const VoxelBox wide{{box.min.x - side, box.min.y - up, box.min.z - side},
                      {box.max.x + side + 1, box.max.y + up + 1, box.max.z + side + 1}};
  return intersect(
      wide, {{-kWorldLimit, -kWorldLimit, -kWorldLimit}, {kWorldLimit, kWorldLimit, kWorldLimit}});
}

ColumnChanges brush_changes(const GroundColumns& columns, const GroundMaterials& materials,
                            const TerrainBrush& brush, std::span<const VoxelPos> places) {
  const VoxelBox& box = columns.box();
  const auto surface = surface_heights(columns, materials);
  const auto weights = brush_weights(box, places, brush.radius, brush.falloff);
  ColumnChanges out;
  if (brush.mode == BrushMode::naturalise || brush.mode == BrushMode::overlay) {
    const std::vector<Material> layers =
        brush.mode == BrushMode::naturalise
            ? common_layers(columns, surface, weights, materials)
            : std::vector<Material>(static_cast<std::size_t>(brush.strength), brush.material);
    for (std::size_t i = 0; i < surface.size(); ++i) {
      if (weights[i] * 2 >= kFullWeight) set_layers(columns, i, surface[i], layers, materials, out);
    }
    return out;
  }
  const HeightField before = height_field(surface, columns.width());
  const HeightField after = shaped_heights(before, weights, box, brush, places.front().y);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (weights[i] != 0 && surface[i] != kNoSurface)
      move_surface(columns, i, surface[i], after.rounded(i), materials, out);
  }
  return out;
}

}  // namespace runstone
