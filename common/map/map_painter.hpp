// The picture of a map. It has shaded relief: slopes towards the west and the north are light, as if
// the sun stood there. Water and glass are tinted by the depth to the ground below them. Pure.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/map/map_materials.hpp"
#include "common/map/map_tops.hpp"

namespace runstone {

/// Returns the pixels of the tops, +x right and +z down: sRGB, red is the lowest byte, alpha the
/// highest. A column without a top is 0, which is transparent. `west` and `north` are the tops of
/// the columns beyond x = 0 and z = 0, which give the slopes at the borders; an empty span: not
/// known. Requires spans of tops.edge columns or empty ones. Heights count in units of `unit` voxels,
/// as wide as the columns: slopes are equal then, and depths are not. Cost: O(columns).
std::vector<std::uint32_t> paint_map(const MapTops& tops, std::span<const ColumnTop> west,
                                     std::span<const ColumnTop> north,
                                     const MapMaterials& materials, std::int32_t unit = 1);

}  // namespace runstone
