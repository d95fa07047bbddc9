// Where to stand to see a box: cameras for pictures that nobody steers.
#pragma once
#include "common/core/coords.hpp"
#include "protocol/codec/draw_order.hpp"

namespace runstone {

/// From which side: as DrawCamera's angles, radians. The default looks down at 35 degrees, past two walls.
struct ViewDirection {
  double yaw = 0.65, pitch = -0.61;
};

/// The camera of this direction that sees the whole box with a margin, no nearer and no farther: the box
/// touches the margin at two opposite sides of the picture. Small boxes are taken with the 16 voxels around their
/// middle, so that one voxel is seen in its surroundings. Nothing of the box is cut away or fades. What stands
/// between eye and box is seen instead. Requires a box that is not empty; beyond some 10^5 voxels it is not seen
/// whole.
DrawCamera oblique_camera(const VoxelBox& box, PictureSize size, ViewDirection direction = {});

/// Moves `near` and `far` so that from this eye nothing of `box` fades into the sky, and distances are told
/// apart as well as they can be.
void fit_distances(DrawCamera& camera, const VoxelBox& box);

}  // namespace runstone
