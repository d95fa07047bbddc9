// The simple mesher (thesis 4.2.3): six quads for each drawn voxel, hidden or not.
#pragma once
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::reference {

/// Replaces `out` by six quads a drawn voxel, 48 bytes each. None is culled, and the border is not
/// read. Cost: O(volume).
void mesh_simple(const DenseGrid& grid, const VisibilityTable& visibility, std::vector<Quad>& out);

}  // namespace runstone::reference
