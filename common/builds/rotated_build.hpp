// Rotated builds: a build turned about an axis by any angle and scaled, by the nearest cell.
// Quarter turns lose nothing and turn the materials, too: turned() makes them.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The range of a scale in percent.
inline constexpr std::int32_t kScaleMin = 10, kScaleMax = 1000;
/// The longest side of a rotated build.
inline constexpr std::int32_t kRotatedSideMax = 2048;

struct BuildRotation {
  Axis axis = Axis::y;
  std::int32_t degrees = 0;    // any number; in the sense in which a player's yaw grows, for y
  std::int32_t percent = 100;  // kScaleMin .. kScaleMax, of each side
};

/// Returns the sides of a rotated build: those of the rotated box, rounded up.
VoxelPos rotated_sides(const BuildRotation& rotation, VoxelPos sides);

/// Returns the build rotated about its middle. Each cell of the result is the cell of the build in
/// which the middle of the cell lies when it is rotated back, or untouched outside the build.
/// Materials stay as they are. Fails with limit_exceeded if a side of the result is longer than
/// kRotatedSideMax or it takes more than `bytes_max`, and with bad_value if no cell is left.
/// Requires a scale in its range. Cost: O(lines of the result along the axis * sections along it *
/// log runs + runs of the result).
Result<BuildPtr> rotated_build(const Build& build, const BuildRotation& rotation,
                               std::size_t bytes_max = kBuildBytesMax);

/// The place from which a rotated build takes a line along the axis.
struct RotatedPlace {
  std::int32_t u = 0, v = 0;  // along the other two axes, ascending; outside the build if not in it
};

/// Returns where in a build of these sides the middle of a line of the rotated build lies.
RotatedPlace place_before_rotation(const BuildRotation& rotation, VoxelPos sides,
                                   RotatedPlace line);

/// Returns the cell along the axis that a cell of the rotated build takes: the one in which its
/// middle lies.
constexpr std::int32_t cell_before_scale(std::int32_t cell, std::int32_t percent) {
  return static_cast<std::int32_t>((std::int64_t{cell} * 2 + 1) * 50 / percent);
}

}  // namespace runstone
