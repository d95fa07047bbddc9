// Grid RDM (thesis 7.2): Run Directional Meshing over a dense grid. Each direction is traversed
// along its own run axis, and consecutive exposed faces become a run strip. A second, greedy phase
// (7.2.2) compares every strip with the row before it and joins equal strips. Faces are culled
// across chunk borders.
#pragma once
#include <cstdint>
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::reference {

/// Buffers that are reused between calls. Thread: one.
struct GridRdmScratch {
  struct Strip {
    std::uint8_t layer, row_first, row_end, begin, end;  // rows and faces along the run: half-open
    Material material;
  };
  std::vector<Strip> strips;                   // of one direction, by layer, row and run
  std::vector<std::uint32_t> row, row_before;  // strips that end in a row, by their begin
};

/// Replaces `out` by the mesh of `grid`. Run and row axis of a direction are the thesis' (in our
/// axes: x faces run along z in rows of y, y faces along z in rows of x, z faces along x in rows of
/// y). Cost: O(volume + strips * strips of a row).
void mesh_grid_rdm(const DenseGrid& grid, const VisibilityTable& visibility,
                   GridRdmScratch& scratch, std::vector<Quad>& out);

}  // namespace runstone::reference
