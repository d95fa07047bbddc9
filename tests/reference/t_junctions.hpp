// T-junctions (thesis 4.2.1): places where a polygon has a vertex and the polygon beside it has
// none, so that rounding can open a gap between them.
#pragma once
#include <cstddef>

#include "tests/reference/surface.hpp"

namespace runstone::reference {

/// A T-junction is a vertex of one polygon inside an edge of another, ends excluded, anywhere in
/// the mesh of the chunk: in one layer or where layers of different directions, materials or passes
/// meet. Polygons are quads and triangles; the diagonal of a drawn quad is no edge. Vertices that
/// meet in one place (the thesis' first case) are no T-junction; its second case is one.
struct TJunctions {
  // Distinct positions of such vertices: the number that is compared between meshers.
  std::size_t places = 0;
  // The same positions, once for each edge of a polygon in which they lie.
  std::size_t edges = 0;
};

/// Counts T-junctions in two passes over the edges, with 0.5 MB of bits. Cost: O(edges * their
/// length).
TJunctions count_t_junctions(const Surface& surface);

}  // namespace runstone::reference
