// Ray walk: finds the first voxel that a ray hits: a cube, or a box of a shape. The caller says which
// material a voxel has, so that chunks may lie anywhere.
// Source: Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing".
#pragma once
#include <functional>
#include <optional>

#include "common/collision/voxel_space.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/world_pos.hpp"
#include "common/shapes/shape_table.hpp"

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

using MaterialPredicate = std::function<bool(Material)>;
/// Returns the material at a position, or nullopt if it is not known.
using MaterialReader = std::function<std::optional<Material>(VoxelPos)>;

/// Walks from `eye` along `look` for at most `reach` voxels. Returns nullopt if nothing is hit, at
/// the first voxel that is not known, or if the eye is not within the world. The planes of plants
/// are hit by their box. The ray goes through the materials for which `passes` returns true; null:
/// through none. Cost: one `read` for each voxel on the way, and the boxes of the shapes there.
std::optional<RayHit> first_hit(const MaterialReader& read, const ShapeTable& shapes,
                                const WorldPos& eye, const LookDirection& look, double reach,
                                const MaterialPredicate& passes = nullptr);

/// Walks through the chunks of a space. Chunks that are not known end the ray. Cost: O(log runs) a
/// voxel.
std::optional<RayHit> first_hit(const VoxelSpace& space, const ShapeTable& shapes,
                                const WorldPos& eye, const LookDirection& look, double reach,
                                const MaterialPredicate& passes = nullptr);

}  // namespace runstone
