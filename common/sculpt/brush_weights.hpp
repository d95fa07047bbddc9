// Brush weights: how strongly a stroke acts on each column.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/sculpt/terrain_brush.hpp"

namespace runstone {

/// The weight of a column on the stroke.
inline constexpr std::int32_t kFullWeight = 256;

/// Returns the weight of each column of an area, 0 .. kFullWeight, by its horizontal distance from
/// the line through the places; the column (x, z) is number (x - box.min.x) + width * (z -
/// box.min.z). Cost: O(columns + places * columns up to the radius around each).
std::vector<std::int32_t> brush_weights(const VoxelBox& box, std::span<const VoxelPos> places,
                                        std::int32_t radius, BrushFalloff falloff);

}  // namespace runstone
