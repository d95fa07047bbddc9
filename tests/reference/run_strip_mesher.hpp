// Run strips (thesis 4.2.7; Vercidium, "Voxel World Optimisations" and "Further Voxel World
// Optimisations", of the game Sector's Edge, 2020; code: Vercidium/voxel-mesh-generation). A quad
// is one voxel high: faces of the x and z sides are joined along y, those of the y sides along x.
// Each voxel has a mark for each direction, set when a run covers that face, so that runs begin
// only at faces that are not covered.
#pragma once
#include <cstdint>
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::reference {

/// The effect of a hidden face of the same material on a run.
enum class HiddenFaces : std::uint8_t {
  end_run,  // ends the run: only exposed faces are drawn
  // has no effect, as in the original: fewer quads and comparisons, but hidden faces are drawn
  run_on
};

/// Buffers that are reused between calls. Thread: one.
struct RunStripScratch {
  // A byte a voxel, y fastest, then x, then z: bit d for direction d.
  std::vector<std::uint8_t> covered;
};

/// Replaces `out` by the mesh of `grid`, by z, x and y of the first voxel of a run and by
/// direction. With HiddenFaces::run_on a run extends from an exposed face to the end of its
/// material. So it draws hidden faces of that material as well, none of them twice. Beside opaque
/// voxels the hidden faces of a transparent material then lie in one plane with the faces that
/// touch them. Cost: O(volume).
void mesh_run_strips(const DenseGrid& grid, const VisibilityTable& visibility, HiddenFaces hidden,
                     RunStripScratch& scratch, std::vector<Quad>& out);

}  // namespace runstone::reference
