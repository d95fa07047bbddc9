// T-junctions (thesis 4.2.1): places where a polygon has a vertex and the polygon beside it has none, so that
// rounding can open a gap between them.
#pragma once
#include <cstddef>

#include "tests/reference/surface.hpp"

namespace runstone::reference {

/// A T-junction is a vertex of one polygon inside an edge of another, ends excluded, anywhere in the mesh of
/// the chunk: in one layer or where layers of different directions, materials or passes meet. Polygons are
/// quads and triangles; the diagonal along which a quad is drawn is none of its edges. Vertices that meet in
/// one place (the thesis' first case) are none; its second case is.
struct TJunctions {
  std::size_t places = 0;  // distinct positions of such vertices: what is compared between meshers
  std::size_t edges = 0;   // the same, once for each edge of a polygon that such a position lies in
};

/// Two passes over the edges, 0.5 MB of bits. O(edges * their length).
TJunctions count_t_junctions(const Surface& surface);

}  // namespace runstone::reference
