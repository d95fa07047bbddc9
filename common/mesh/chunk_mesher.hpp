// The mesh of a chunk of cubes and shapes: mesh_rdm() for the cubes, then mesh_shapes() for the
// rest, and add_liquid_steps() where the surfaces of liquids end.
#pragma once
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/shapes/shape_mesher.hpp"

namespace runstone {

/// The buffers of both. A scratch belongs to one thread, and callers do not use its contents.
struct ChunkMeshScratch {
  RdmScratch cubes;
  ShapeScratch shapes;
};

/// Replaces `out` by the mesh of `chunk`. Requires what mesh_rdm() with kept borders does; borders
/// are those of `materials.cubes`. Thread: any, with one scratch each. Cost: that of mesh_rdm(),
/// mesh_shapes() and add_liquid_steps().
void mesh_chunk(const RunChunk& chunk, const MeshNeighbours& neighbours, const MeshBorders& borders,
                const MeshMaterials& materials, ChunkMeshScratch& scratch, ChunkMesh& out,
                ChunkBorders* chunk_borders = nullptr);

/// Meshes again the layers of cubes that an edit touched, as mesh_rdm_layers() does, and all shapes
/// and steps of the chunk. The quads are equal to those of mesh_chunk(), in the same order.
/// Requires what mesh_rdm_layers() does; the shapes of `mesh` are not read. Returns true if only
/// layers of cubes were meshed.
bool mesh_chunk_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                       const MeshBorders& borders, const MeshMaterials& materials,
                       const DirtyLayers& dirty,
                       const std::array<DirtyLayers, kDirectionCount>& beyond,
                       ChunkMeshScratch& scratch, ChunkMesh& mesh);

}  // namespace runstone
