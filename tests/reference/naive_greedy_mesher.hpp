// Naive greedy meshing (thesis 4.2.6, which cites Blackflux, "Meshing in Voxel Engines", part 2,
// 2014). The thesis says that it is simpler and faster than greedy meshing, that it merges worse,
// and (figure 4.6) that it misses the best partition. This is the algorithm of Blackflux's voxel
// editor (simlu/voxelshop, Grid2TriNaiveGreedy):
// - The mask is the only record: a face is removed from it when it is compared, and the faces of a
//   row that does not fit are put back.
// - Both ends of a next row are compared first, since most rows that do not fit fail there.
// - Faces are searched column by column, but a quad grows along its row first. Greedy meshing
//   searches row by row. So a quad begins at the leftmost remaining face, not at the topmost one.
// Unlike Grid RDM it joins different rows: a next row may be longer, and is then cut.
#pragma once
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/face_plane.hpp"

namespace runstone::reference {

/// Buffers that are reused between calls. Thread: one.
struct NaiveGreedyScratch {
  FacePlane plane;
};

/// Replaces `out` by the mesh of `grid`, by direction, layer and column of the first face. Cost:
/// O(volume).
void mesh_naive_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                       NaiveGreedyScratch& scratch, std::vector<Quad>& out);

}  // namespace runstone::reference
