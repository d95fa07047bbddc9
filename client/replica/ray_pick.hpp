// Ray pick: the first voxel that a look hits, read from the shown runs (O(log runs) a step).
// Source: Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing".
#pragma once
#include <optional>

#include "client/replica/replica.hpp"
#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct RayHit {
  VoxelPos voxel;  // not empty
  Material material = kEmpty;
  std::optional<Direction>
      face;             // the face the ray came in by; none if the ray starts inside the voxel
  double distance = 0;  // from the eye to that face, voxels
};

/// Direction of a look; yaw 0 looks along +z and grows towards +x, pitch is positive upward. Radians;
/// length 1.
struct LookDirection {
  double x = 0, y = 0, z = 1;
};
LookDirection look_direction(double yaw, double pitch);

/// Walks from `eye` along `look` for at most `reach` voxels. A chunk that is not shown ends the walk without
/// a hit: nobody digs in what they cannot see.
std::optional<RayHit> pick(const Replica& replica, const WorldPos& eye, const LookDirection& look,
                           double reach);

/// Where a voxel placed against the hit face goes; none if the ray started inside it.
std::optional<VoxelPos> place_against(const RayHit& hit);

}  // namespace runstone
