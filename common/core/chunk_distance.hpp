// The distance of chunks, by which work is ordered.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"

namespace runstone {

/// Returns the square of the distance of two chunks, in chunks. Exact for all chunks of a world.
constexpr std::int64_t distance_squared(ChunkCoord a, ChunkCoord b) {
  const std::int64_t dx = std::int64_t{a.x} - b.x;
  const std::int64_t dy = std::int64_t{a.y} - b.y;
  const std::int64_t dz = std::int64_t{a.z} - b.z;
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace runstone
