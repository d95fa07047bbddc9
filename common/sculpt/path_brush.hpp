// PathBrush: a way along a curve through places on the ground.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/ground_columns.hpp"
#include "common/sculpt/ground_surface.hpp"

namespace runstone {

enum class PathHeight : std::uint8_t {
  ground,  // the way lies on the ground as it is
  // The height follows the curve: low ground is filled, high ground is cut, deep ground is bridged.
  even,
};

/// The voxels that a way is wide, at most.
inline constexpr std::int32_t kPathWidthMax = 64;
/// The voxels above an even way that are cleared of ground.
inline constexpr std::int32_t kPathHeadroom = 4;
/// Ground that lies deeper below an even way than this is bridged instead of filled.
inline constexpr std::int32_t kPathFillMax = 6;

struct PathBrush {
  std::int32_t width = 3;  // voxels, 1 .. kPathWidthMax
  PathHeight height = PathHeight::ground;
  Material material = kEmpty;
};

/// A point of the curve, in voxels.
struct CurvePoint {
  double x = 0, y = 0, z = 0;
};

/// Returns a curve through the middles of the places, as points at most half a voxel apart. Source:
/// centripetal Catmull-Rom splines (Barry and Goldman 1988), which have no loops between places.
/// Requires at least one place.
std::vector<CurvePoint> curve_through(std::span<const VoxelPos> places);

/// Returns the box that path_changes() reads.
VoxelBox path_box(const PathBrush& brush, std::span<const CurvePoint> curve);

/// Returns what the way changes: the columns up to half the width from the curve. Columns without a
/// surface stay as they are. Cost: O(runs + points * width * width).
ColumnChanges path_changes(const GroundColumns& columns, const GroundMaterials& materials,
                           const PathBrush& brush, std::span<const CurvePoint> curve);

}  // namespace runstone
