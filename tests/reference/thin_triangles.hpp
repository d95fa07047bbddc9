// Long, thin triangles (thesis 4.2.2): they shade many pixels that they do not cover.
#pragma once
#include <cstddef>

#include "tests/reference/surface.hpp"

namespace runstone::reference {

/// Triangles whose longest edge is more than 16 times, 100 times as long as their height over it; the thesis
/// suspects those above 1:100. A quad counts as the two triangles it is drawn as.
struct ThinTriangles {
  std::size_t above_16 = 0;
  std::size_t above_100 = 0;  // also counted in the others
};

/// Exact, in integers. O(triangles).
ThinTriangles count_thin_triangles(const Surface& surface);

}  // namespace runstone::reference
