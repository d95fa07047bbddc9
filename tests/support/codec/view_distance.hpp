// Distances of chunks from the centre of a view, for tests of the order in which chunks are sent.
#pragma once
#include <cstdint>

#include "protocol/codec/messages.hpp"

namespace runstone::test {

/// Returns the squared distance from the view's centre, in chunks.
inline std::int64_t distance2(const View& view, ChunkCoord at) {
  const std::int64_t dx = std::int64_t{at.x} - view.centre.x;
  const std::int64_t dy = std::int64_t{at.y} - view.centre.y;
  const std::int64_t dz = std::int64_t{at.z} - view.centre.z;
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace runstone::test
