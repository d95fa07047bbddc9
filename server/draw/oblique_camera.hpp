// Cameras that show a box, for pictures without a player.
#pragma once
#include "common/core/coords.hpp"
#include "protocol/codec/draw_order.hpp"

namespace runstone {

/// The direction of view, in radians, in the form of the angles of DrawCamera. The default looks
/// down at 35 degrees, diagonally past two walls.
struct ViewDirection {
  double yaw = 0.65, pitch = -0.61;
};

/// Returns the camera of this direction that is nearest to the box and still sees all of it with a
/// margin. The box touches the margin on two opposite sides of the picture. A side shorter than 16
/// voxels counts as 16, so that a single voxel is seen in its surroundings. No part of the box is
/// clipped or fades into fog, but voxels between eye and box may hide it. Requires a box that is
/// not empty. A box of more than about 10^5 voxels a side is not seen as a whole.
DrawCamera oblique_camera(const VoxelBox& box, PictureSize size, ViewDirection direction = {});

/// Sets `near` and `far` so that from this eye no part of `box` fades into fog, and the depth
/// buffer has the best resolution that this allows.
void fit_distances(DrawCamera& camera, const VoxelBox& box);

}  // namespace runstone
