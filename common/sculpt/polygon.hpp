// Polygon: a prism over a polygon of clicked corners. It is made of runs, without a grid.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/solid.hpp"

namespace runstone {

/// The corners of a polygon, at most.
inline constexpr std::size_t kPolygonCornersMax = 256;

struct Prism {
  std::int32_t height = 1;  // voxels
  SolidFill fill = SolidFill::solid;
  std::int32_t wall = 1;  // voxels, of `hollow` and `walls`
};

/// Returns the prism that stands at the height of the first corner; the heights of the others do
/// not count. A column belongs to it if its middle lies inside the polygon by the even-odd rule, or
/// if it is on the line of a side: of the columns along the longer way of the side, the nearest one
/// across. So two corners make a straight wall. The hollow inside is made of the columns around
/// which all columns within `wall` along both axes belong to the prism. Fails with limit_exceeded
/// if a side of the box is longer than kSolidSideMax. Requires 1 .. kPolygonCornersMax corners
/// inside the world, and a height and a wall of at least 1. Cost: O(rows of the box * corners, and
/// rows * wall * stretches).
Result<PlacedBuild> polygon_build(const Prism& prism, std::span<const VoxelPos> corners,
                                  Material material);

}  // namespace runstone
