// Orbit: the path of the camera, the same for every mesher. It circles a block of chunks once, with
// all of it in view, while it rises and sinks.
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "client/render/renderer.hpp"

namespace runstone::bench {

/// Returns the camera of frame `frame` of `frames` around the block from 0 0 0 to `size`, in
/// voxels.
Camera orbit_camera(const std::array<int, 3>& size, unsigned frame, unsigned frames);

/// Returns the matrix from the block's space to clip space: the view and projection of
/// Renderer::draw() with the eye in the matrix. A voxel corner that two chunks share is the same
/// number in both.
glm::mat4 clip_of(const Camera& camera, int width, int height);

}  // namespace runstone::bench
