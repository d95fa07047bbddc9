// Ray pick: finds the first voxel that a ray hits in the shown runs: a cube, or a box of a shape.
// Cost: O(log runs) a step, and the boxes of the shapes on the way.
// Source: Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing".
#pragma once
#include <functional>
#include <optional>

#include "client/replica/replica.hpp"
#include "common/core/coords.hpp"
#include "common/shapes/shape_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct RayHit {
  VoxelPos voxel;  // not empty
  Material material = kEmpty;
  /// The face through which the ray entered the voxel, or the box of its shape; nullopt if the ray
  /// starts inside.
  std::optional<Direction> face;
  double distance = 0;  // from the eye to that face, voxels
};

/// A direction of length 1.
struct LookDirection {
  double x = 0, y = 0, z = 1;
};
/// Returns the direction of a look. Yaw 0 looks along +z and grows towards +x; pitch is positive
/// upward. Both are in radians.
LookDirection look_direction(double yaw, double pitch);

using MaterialPredicate = std::function<bool(Material)>;

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
