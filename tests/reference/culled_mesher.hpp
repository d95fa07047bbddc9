// The culled mesher (thesis 4.2.4): a quad for each exposed face, nothing merged. It works from a
// grid, or as Voxel Plugin's cubic mesher does (thesis 6.3.1): samples of the chunk and of one
// voxel around it (34 x 34 x 34 for its chunks of 32) are read from an octree right before meshing.
#pragma once
#include <cstdint>
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/material_octree.hpp"

namespace runstone::reference {

/// Replaces `out` by the exposed faces of `grid`, voxel by voxel. Cost: O(volume).
void mesh_culled(const DenseGrid& grid, const VisibilityTable& visibility, std::vector<Quad>& out);

/// The times of the phases of one mesh, in the clock's units.
struct CulledPhases {
  std::uint64_t octree = 0;   // reading the samples
  std::uint64_t meshing = 0;  // culling, and writing the quads
};
/// A monotonic clock. The caller passes it, because this code reads none.
using Clock = std::uint64_t (*)();

/// Meshes the chunk of `extent` at `first`, sampled from `octree` into `grid` (scratch). Calls
/// `now` three times.
CulledPhases mesh_culled(const MaterialOctree& octree, VoxelPos first, Extent extent,
                         const VisibilityTable& visibility, Clock now, DenseGrid& grid,
                         std::vector<Quad>& out);

}  // namespace runstone::reference
