// Row build: a build of one material whose shape is given row by row. A row is a few stretches of
// voxels, so nothing is tested voxel by voxel.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/sculpt/row_stretches.hpp"

namespace runstone {

/// Appends the stretches of the row along x at y and z. They ascend, do not overlap, and lie inside
/// the box.
using RowSource = std::function<void(std::int32_t y, std::int32_t z, std::vector<RowStretch>& out)>;

/// Returns the build of these rows. The shape is made with its axis upright: y and `axis` are
/// exchanged at the end. `upright` has the sides before the exchange. Calls `rows` once for each
/// row. Fails with bad_value if there is no voxel, and with limit_exceeded if the build takes too
/// much memory. Requires sides of at least 1. Cost: O(rows * sections along them + stretches).
Result<BuildPtr> build_of_rows(VoxelPos upright, Axis axis, Material material,
                               const RowSource& rows);

/// Exchanges y with an axis. The exchange is its own inverse.
VoxelPos with_upright(VoxelPos sides, Axis axis);

}  // namespace runstone
