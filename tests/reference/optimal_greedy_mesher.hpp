// Optimal greedy meshing (thesis 4.2.9, which cites Blackflux, "Meshing in Voxel Engines", part 2,
// 2014, and Eppstein): the faces of each layer of each direction in the fewest possible rectangles
// (minimum_partition.hpp). No mesher whose quads are rectangles of exposed faces of one material
// needs fewer. It is the optimum for the others; its speed does not matter.
#pragma once
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/minimum_partition.hpp"

namespace runstone::reference {

/// Buffers that are reused between calls. Thread: one.
struct OptimalGreedyScratch {
  FacePlane plane;
  MinimumPartition partition;
  std::vector<PlaneRectangle> rectangles;
};

/// Replaces `out` by the mesh of `grid`, by direction, layer and row of the first face. Cost:
/// O(volume), and for each layer of n chords that meet in m places O(m * sqrt(n)).
void mesh_optimal_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                         OptimalGreedyScratch& scratch, std::vector<Quad>& out);

}  // namespace runstone::reference
