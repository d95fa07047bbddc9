// Greedy meshing (thesis 4.2.5; M. Lysenko, "Meshing in a Minecraft Game", 0fps.net, 2012). Each
// layer of each direction becomes a mask of faces. The first remaining face, row by row, starts a
// quad. The quad grows as wide as its row allows and then as high as whole rows of that width
// follow. Of all quads that could start there this is the least in Lysenko's order: first place,
// then widest, then highest.
#pragma once
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/face_plane.hpp"

namespace runstone::reference {

/// Buffers that are reused between calls. Thread: one.
struct GreedyScratch {
  FacePlane plane;
};

/// Replaces `out` by the mesh of `grid`, by direction, layer and row of the first face. Cost:
/// O(volume).
void mesh_greedy(const DenseGrid& grid, const VisibilityTable& visibility, GreedyScratch& scratch,
                 std::vector<Quad>& out);

}  // namespace runstone::reference
