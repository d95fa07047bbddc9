// MeshFigures: the size of a mesh and the counts of its parts, for any mesher.
#pragma once
#include <cstddef>

#include "tests/reference/surface.hpp"
#include "tests/reference/t_junctions.hpp"
#include "tests/reference/thin_triangles.hpp"

namespace runstone::bench {

struct MeshFigures {
  std::size_t bytes = 0;  // as the mesher writes it: 8 a quad, or 3 a vertex and 16 a triangle
  std::size_t vertices = 0, triangles = 0;  // 4 and 2 a quad
  reference::TJunctions t_junctions;
  reference::ThinTriangles thin;
};

/// Counts the parts of a surface. Cost: O(edges * their length); not for timed code.
MeshFigures figures_of(const reference::Surface& surface);

}  // namespace runstone::bench
