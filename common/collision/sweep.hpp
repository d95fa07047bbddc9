// Sweep: moves a box through the voxels of a VoxelSpace until it meets a solid one. It unpacks
// nothing: each layer of voxels that the box enters is one box query over runs. The boxes of shapes
// on the way are tested one by one. Faces that only touch do not collide, so a body can stand on
// the ground and slide along a wall. A voxel that the box overlaps at the start does not stop it,
// so that a body that somebody has built into a wall can leave. Source: the walk from border to
// border is that of Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing",
// with the leading faces of a box in place of a point.
#pragma once
#include <array>
#include <optional>

#include "common/collision/obstacles.hpp"
#include "common/collision/voxel_space.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/core/world_pos.hpp"

namespace runstone {

/// A box in the world, in voxels, such as the body of a player. min < max on each axis.
struct BodyBox {
  WorldPos min, max;
  friend bool operator==(const BodyBox&, const BodyBox&) = default;
};

/// Boxes and voxels that overlap by less than this, in voxels, only touch. It covers the rounding
/// of positions within the world, whose step is 2^-23 at most.
inline constexpr double kTouchDepth = 1e-6;
/// The longest move of one sweep along each axis, voxels. It bounds the cost.
inline constexpr double kSweepMax = 256;

struct SweepHit {
  double fraction = 0;  // of the move that was possible, 0 .. 1
  Direction face{};     // of the voxel or box of a shape that was hit, towards the body
  VoxelPos voxel;       // one of those that were hit
};

/// Returns success if sweep() and slide() can move the box so. Fails with bad_value if a number is
/// not finite, the box has 2 * kTouchDepth or less on an axis, the move is longer than kSweepMax on an axis, or the
/// way leaves the world.
Result<void> validate_move(const BodyBox& box, const WorldPos& move);

/// Returns the first obstacle that the box meets on the way along `move` (voxels), or nullopt if
/// the way is free. Requires finite numbers, |move| <= kSweepMax on each axis, and that the way
/// lies within the world. Cost: one find_voxel() for each layer of voxels that the box enters, and
/// a test for each box of the shapes on the way.
std::optional<SweepHit> sweep(const VoxelSpace& space, const Obstacles& solid, const BodyBox& box,
                              const WorldPos& move);

/// Returns true if a voxel of the set overlaps the box. A shape counts as its whole voxel.
bool overlaps(const VoxelSpace& space, const MaterialSet& materials, const BodyBox& box);
/// Returns true if a cube or a box of a shape overlaps the box.
bool overlaps(const VoxelSpace& space, const Obstacles& solid, const BodyBox& box);

/// Returns true if the space knows every chunk that the box overlaps.
bool is_known(const VoxelSpace& space, const BodyBox& box);

/// The end of a move that slid along what it met.
struct Slide {
  WorldPos moved;                                  // the displacement that was possible
  std::array<bool, kDirectionCount> is_stopped{};  // by Direction of the move: it met a solid voxel
};

/// Moves the box and, where it meets a solid voxel, goes on with the rest of the move along the
/// other axes. Requires what sweep() requires. Cost: that of three sweeps.
Slide slide(const VoxelSpace& space, const Obstacles& solid, const BodyBox& box,
            const WorldPos& move);

}  // namespace runstone
