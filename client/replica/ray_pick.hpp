// Ray pick: finds the first voxel that a ray hits in the shown runs: a cube, or a box of a shape.
// Cost: O(log runs) a step, and the boxes of the shapes on the way.
#pragma once
#include <optional>

#include "client/replica/replica.hpp"
#include "common/collision/ray_walk.hpp"
#include "common/core/coords.hpp"
#include "common/shapes/shape_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Returns the direction of a look. Yaw 0 looks along +z and grows towards +x; pitch is positive
/// upward. Both are in radians.
LookDirection look_direction(double yaw, double pitch);

/// Walks from `eye` along `look` for at most `reach` voxels. Returns nullopt if nothing is hit, or
/// at the first chunk that is not shown: a player cannot edit what is not visible. The planes of
/// plants are hit by their box. The ray goes through the materials for which `passes`
/// returns true; null: through none.
std::optional<RayHit> pick(const Replica& replica, const ShapeTable& shapes, const WorldPos& eye,
                           const LookDirection& look, double reach,
                           const MaterialPredicate& passes = nullptr);

/// Returns the position of a voxel placed against the hit face, or nullopt if the ray started
/// inside the hit voxel.
std::optional<VoxelPos> place_against(const RayHit& hit);

}  // namespace runstone
