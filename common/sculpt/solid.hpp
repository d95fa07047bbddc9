// Solids: ellipsoids, cylinders and other bodies of one material that fill a box. They are made of
// runs, without a grid. A row of a solid is at most two stretches, so nothing is tested voxel by
// voxel.
#pragma once
#include <cstdint>

#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

enum class SolidKind : std::uint8_t {
  ellipsoid,
  dome,  // the upper half of an ellipsoid
  cylinder,
  cone,
  pyramid,
  torus,  // its tube is as thick as the box is high, at most half of the shorter side
};
inline constexpr int kSolidKindCount = 6;

enum class SolidFill : std::uint8_t {
  solid,
  hollow,  // a shell; a dome is open below
  walls,   // a shell without lid and floor; a torus is hollow
};
inline constexpr int kSolidFillCount = 3;

/// The longest side of a solid.
inline constexpr std::int32_t kSolidSideMax = 1024;

struct Solid {
  SolidKind kind = SolidKind::ellipsoid;
  SolidFill fill = SolidFill::solid;
  std::int32_t wall = 1;  // voxels, of `hollow` and `walls`
  Axis axis =
      Axis::y;  // of the cylinder, cone, pyramid, dome and torus; the tip is at its high end
};

/// Returns the solid that fills a box of these sides. A voxel belongs to it if its centre does. The
/// hollow inside is the same solid in a box that is `wall` smaller on each side. Fails with
/// bad_value if no voxel belongs to it, and with limit_exceeded if a side is longer than
/// kSolidSideMax or the build takes too much memory. Requires sides and a wall of at least 1. Cost:
/// O(rows * sections along them).
Result<BuildPtr> solid_build(const Solid& solid, VoxelPos sides, Material material);

}  // namespace runstone
