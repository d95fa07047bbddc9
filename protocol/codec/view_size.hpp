// View size: the chunk coordinates that a world has, and the number of chunks in a view. A view may
// extend beyond the world; it has no chunks there, and nothing is sent for them.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Chunk coordinates of a world are in [-limit, limit).
struct CoordLimit {
  std::int32_t limit = kWorldLimit;
  /// Returns the limit of a world whose chunks have this edge, in voxels.
  static CoordLimit of(std::int32_t chunk_edge) { return {kWorldLimit / chunk_edge}; }
  constexpr bool contains(std::int64_t c) const { return c >= -limit && c < limit; }
  constexpr bool contains(ChunkCoord c) const {
    return contains(c.x) && contains(c.y) && contains(c.z);
  }
};

/// Returns true if the view has this chunk and the world has it too.
inline bool has_chunk(const View& view, CoordLimit world, ChunkCoord at) {
  return view.contains(at) && world.contains(at);
}

/// Returns the number of chunks of the view that the world has. Cost: O(radius_h^2 + radius_v).
inline std::size_t chunks_in(const View& view, CoordLimit world) {
  const std::int64_t radius = view.radius_h, height = view.radius_v;
  std::size_t columns = 0, levels = 0;
  for (std::int64_t dx = -radius; dx <= radius; ++dx) {
    for (std::int64_t dz = -radius; dz <= radius; ++dz) {
      const bool is_inside = dx * dx + dz * dz <= radius * radius &&
                             world.contains(view.centre.x + dx) &&
                             world.contains(view.centre.z + dz);
      if (is_inside) ++columns;
    }
  }
  for (std::int64_t dy = -height; dy <= height; ++dy) {
    if (world.contains(view.centre.y + dy)) ++levels;
  }
  return columns * levels;
}

}  // namespace runstone
