// Orbit: the path of the camera, the same for every mesher: once around a block of chunks, all of which is in
// view, while it rises and sinks.
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "client/render/renderer.hpp"

namespace runstone::bench {

/// Frame `frame` of `frames` around the block from 0 0 0 to `size`, in voxels.
Camera orbit_camera(const std::array<int, 3>& size, unsigned frame, unsigned frames);

/// Clip space from the block's: the view and projection of Renderer::draw(), but with the eye in the matrix,
/// so that a voxel corner that two chunks share is the same number in both.
glm::mat4 clip_of(const Camera& camera, int width, int height);

}  // namespace runstone::bench
