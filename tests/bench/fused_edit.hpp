// The fused sweep of edit and mesh (thesis 7.3.3), as an experiment beside apply_stack() and
// mesh_rdm_layers(): one walk over the runs finds the edit index, makes the rows that the edit touches and
// splices the edit in; meshing resumes from these rows. Its quads go the way of mesh_rdm_layers(), so that
// what the two differ in is the fusion alone.
#pragma once
#include <array>

#include "common/core/digest.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"

namespace runstone::bench {

/// Materials of the rows around an edited voxel.
struct TouchedRows {
  using Row = std::array<Material, kSideMax>;
  std::array<Row, 3> slow;  // lines: in the slow layer before, the edit's and the one behind
  std::array<Row, 3> mid;   // lines: before, the edit's, behind in its slow layer
  std::array<Row, 3> fast;  // voxels before, at, behind the edit's place in all lines of its slow layer
};

/// Sets one voxel, with digest and mesh following: equal to mesh_rdm() of the chunk behind, quad for quad.
/// Requires the mesh of the chunk before, in its order. O(runs of the edit's slow layer + quads moved).
void edit_fused(RunChunk& chunk, Digest& digest, LocalPos at, Material material,
                const MeshNeighbours& neighbours, const VisibilityTable& visibility, TouchedRows& rows,
                RdmScratch& scratch, ChunkMesh& mesh);

/// The walk and the meshing alone, after the edit was applied: what of it the fusion is not needed for.
void remesh_walked(const RunChunk& chunk, LocalPos at, const MeshNeighbours& neighbours,
                   const VisibilityTable& visibility, TouchedRows& rows, RdmScratch& scratch,
                   ChunkMesh& mesh);

}  // namespace runstone::bench
