// Liquid steps: the narrow faces where a lowered surface of a liquid ends at a voxel of the same
// liquid that reaches its full height. The renderer draws the upper faces of liquids, and the upper
// edges of their lateral faces, kLiquidDrop lower. The mesh of the cubes has no face between equal
// liquids, so without the steps there would be gaps.
#pragma once
#include <cstdint>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"

namespace runstone {

/// The surface of a liquid lies so many sixteenths of a voxel lower than its cube.
inline constexpr int kLiquidDrop = 2;
/// The face of a quad that stands for the upper kLiquidDrop sixteenths of lateral faces of a
/// liquid. It is one voxel high.
inline constexpr std::uint16_t kLiquidStepFace = 1;

/// Appends the steps of the liquids (MeshMaterials::liquids) to the transparent quads of shapes,
/// which ascend by direction afterwards. `mesh` is the mesh of the chunk. A voxel is *covered* if
/// an opaque cube or the same liquid lies above it: it has no upper face, and reaches its full
/// height. A step is
///   - on the side of a voxel with an upper face towards a covered voxel of the same liquid;
///   - on a drawn side of a covered voxel, if its quad ends there: the renderer lowers that edge.
/// A step in the highest layer of the chunk towards another chunk is left out, because the voxel
/// above it is in no neighbour. So are steps towards chunks that are missing. Requires what
/// mesh_chunk() does. The result is deterministic, and does not depend on axis orders but by the
/// order and the joins of quads. Cost: O(1) if no material is a liquid; otherwise O(transparent
/// quads + log runs for each voxel at the sides of the quads of liquids).
void add_liquid_steps(const RunChunk& chunk, const MeshNeighbours& neighbours,
                      const MeshMaterials& materials, ChunkMesh& mesh);

}  // namespace runstone
