// View size: the number of chunks in a view.
#pragma once
#include <cstddef>

#include "protocol/codec/messages.hpp"

namespace runstone {

/// Cost: O(radius_h^2).
inline std::size_t chunks_in(const View& view) {
  const int radius = view.radius_h;
  std::size_t columns = 0;
  for (int dx = -radius; dx <= radius; ++dx) {
    for (int dz = -radius; dz <= radius; ++dz)
      columns += dx * dx + dz * dz <= radius * radius ? 1U : 0U;
  }
  return columns * (2U * view.radius_v + 1U);
}

}  // namespace runstone
