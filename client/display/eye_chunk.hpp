// The chunk in which the eye of a camera is.
#pragma once
#include <cmath>
#include <cstdint>

#include "client/render/renderer.hpp"
#include "common/core/coords.hpp"

namespace runstone {

/// `edge` is that of all chunks, in voxels; returns the chunk at the origin if it is 0. Requires an
/// eye within the limits of a world.
inline ChunkCoord chunk_of_eye(const Camera& camera, std::int32_t edge) {
  if (edge == 0) return {};
  const auto chunk = [edge](double at) {
    return static_cast<std::int32_t>(std::floor(at / static_cast<double>(edge)));
  };
  return {chunk(camera.x), chunk(camera.y), chunk(camera.z)};
}

}  // namespace runstone
