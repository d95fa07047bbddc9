// Tube: a round bar along a curve or along straight lines through places. It is made of runs, without
// a grid.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/path_brush.hpp"

namespace runstone {

/// The voxels that a tube is thick, at most.
inline constexpr std::int32_t kTubeThicknessMax = 32;
/// The voxels along the line of a tube, at most.
inline constexpr std::int32_t kTubeLengthMax = 8192;

enum class TubeBend : std::uint8_t {
  curve,     // curve_through() the places
  straight,  // straight lines from place to place
};

struct Tube {
  std::int32_t thickness = 1;  // voxels, 1 .. kTubeThicknessMax
  TubeBend bend = TubeBend::curve;
};

/// Returns the line of a tube, as points at most half a voxel apart. The middle of a tube of an
/// even thickness lies between voxels. Requires at least one place.
std::vector<CurvePoint> tube_line(const Tube& tube, std::span<const VoxelPos> places);

/// Returns the voxels whose middle is at most half the thickness from a point of tube_line(), and
/// those in which one of its points lies. Fails with limit_exceeded if the tube is longer than
/// kTubeLengthMax along its line, or if a side of its box is longer than kSolidSideMax. Requires at
/// least one place, and places of which consecutive ones are at most kStrokeStepMax apart. Cost:
/// O(points * thickness * thickness + rows of the box).
Result<PlacedBuild> tube_build(const Tube& tube, std::span<const VoxelPos> places,
                               Material material);

}  // namespace runstone
