// TerrainBrush: a brush that shapes ground along a stroke. It reads columns of runs and returns the
// voxels that change. A stroke becomes a paste, so the server, undo and replay need no code for
// brushes.
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

enum class BrushMode : std::uint8_t {
  raise,    // the surface rises by `strength`, or sinks if `lowers`
  flatten,  // the surface moves to the height of the first place
  // The surface moves to the mean height of the columns up to 2 * `strength` away, of which near
  // ones count more.
  smooth,
  erode,       // ground slides down slopes that are steeper than 45 degrees, `strength` times
  noise,       // hills of up to `strength` voxels
  naturalise,  // each of the upper layers becomes the material that most columns have there
  overlay,     // the upper `strength` voxels become `material`
};
inline constexpr int kBrushModeCount = 7;

/// The share of the strength by the distance from the stroke: 1 on it, 0 at the radius.
enum class BrushFalloff : std::uint8_t {
  smooth,  // 1 - smoothstep
  linear,
  round,  // as the height of a half sphere
  none,   // 1 up to the radius
};
inline constexpr int kBrushFalloffCount = 4;

inline constexpr std::int32_t kBrushRadiusMax = 128;
inline constexpr std::int32_t kBrushStrengthMax = 64;

struct TerrainBrush {
  BrushMode mode = BrushMode::raise;
  BrushFalloff falloff = BrushFalloff::smooth;
  std::int32_t radius = 8;     // voxels, 1 .. kBrushRadiusMax
  std::int32_t strength = 4;   // 1 .. kBrushStrengthMax; its unit depends on the mode
  bool lowers = false;         // `raise` sinks, and the hills of `noise` become hollows
  Material material = kEmpty;  // for `overlay`
  std::uint64_t seed = 1;      // of `noise`
};

/// Returns the box that a brush reads for a stroke through these voxels of the surface: the columns
/// up to the radius, and those beside that the mode reads. Above and below the places it has room
/// for slopes. It is cut to the world. Requires at least one place and valid numbers.
VoxelBox brush_box(const TerrainBrush& brush, std::span<const VoxelPos> places);

/// Returns what the stroke changes. Columns without a surface stay as they are. Requires the
/// columns of brush_box(). Cost: O(runs + columns * places), and for `erode` O(columns * strength).
ColumnChanges brush_changes(const GroundColumns& columns, const GroundMaterials& materials,
                            const TerrainBrush& brush, std::span<const VoxelPos> places);

}  // namespace runstone
