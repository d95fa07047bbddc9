// Naive greedy meshing (thesis 4.2.6, which cites Blackflux, "Meshing in Voxel Engines", part 2, 2014). The
// thesis says of it only that it is simpler and faster than greedy meshing, that it merges worse, and (figure
// 4.6) that it misses the best partition. What is built here is what Blackflux's voxel editor does
// (simlu/voxelshop, Grid2TriNaiveGreedy):
//   - there is no record of what is done but the mask: a face is taken out of it as it is compared, and those
//     of a row that does not fit are put back;
//   - of a next row both ends are looked at first, since most rows that do not fit fail there;
//   - faces are looked for column by column, but a quad grows along its row first. Greedy meshing looks row by
//     row. So a quad begins at the leftmost face that is left, not at the topmost one.
// Unlike Grid RDM it joins rows that are not alike: a next row may be longer, and is then cut.
#pragma once
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/face_plane.hpp"

namespace runstone::reference {

/// Buffers reused between calls. Belongs to one thread.
struct NaiveGreedyScratch {
  FacePlane plane;
};

/// Replaces `out` by the mesh of `grid`, by direction, layer and column of the first face. O(volume).
void mesh_naive_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                       NaiveGreedyScratch& scratch, std::vector<Quad>& out);

}  // namespace runstone::reference
