// Run strips (thesis 4.2.7; Vercidium, "Voxel World Optimisations" and "Further Voxel World Optimisations", of
// the game Sector's Edge, 2020; its code is Vercidium/voxel-mesh-generation). A quad is one voxel high: faces
// of the x and z sides are joined along y, those of the y sides along x. Each voxel has a mark for each
// direction, set when a run has covered that face, so that runs begin where no other has been.
#pragma once
#include <cstdint>
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::reference {

/// What a hidden face of the same material does to a run.
enum class HiddenFaces : std::uint8_t {
  end_run,  // ends it: exposed faces are drawn and no others
  run_on  // nothing, as in the original: fewer quads and comparisons, and hidden faces that are drawn
};

/// Buffers reused between calls. Belongs to one thread.
struct RunStripScratch {
  std::vector<std::uint8_t>
      covered;  // a byte a voxel, y fastest, then x, then z: bit d for direction d
};

/// Replaces `out` by the mesh of `grid`, by z, x and y of the voxel that begins a run and by direction. With
/// HiddenFaces::run_on a run goes from an exposed face to the end of its material, so it draws hidden faces of
/// that material as well, none of them twice; beside opaque voxels those of a transparent material then lie in
/// one plane with the faces that look at them. O(volume).
void mesh_run_strips(const DenseGrid& grid, const VisibilityTable& visibility, HiddenFaces hidden,
                     RunStripScratch& scratch, std::vector<Quad>& out);

}  // namespace runstone::reference
