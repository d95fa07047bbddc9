// Long, thin triangles (thesis 4.2.2), which shade many pixels that they do not cover.
#pragma once
#include <cstddef>

#include "tests/reference/surface.hpp"

namespace runstone::reference {

/// The triangles whose longest edge is more than 16 times or 100 times as long as their height over
/// it. The thesis suspects those above 1:100. A quad counts as the two triangles as which it is
/// drawn.
struct ThinTriangles {
  std::size_t above_16 = 0;
  std::size_t above_100 = 0;  // also counted above 16
};

/// Exact, in integers. Cost: O(triangles).
ThinTriangles count_thin_triangles(const Surface& surface);

}  // namespace runstone::reference
