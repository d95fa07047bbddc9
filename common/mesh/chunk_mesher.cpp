#include "common/mesh/chunk_mesher.hpp"

#include "common/mesh/shapes/liquid_steps.hpp"

namespace runstone {

void mesh_chunk(const RunChunk& chunk, const MeshNeighbours& neighbours, const MeshBorders& borders,
                const MeshMaterials& materials, ChunkMeshScratch& scratch, ChunkMesh& out,
                ChunkBorders* chunk_borders) {
  mesh_rdm(chunk, neighbours, borders, materials.cubes, scratch.cubes, out, chunk_borders);
  mesh_shapes(chunk, neighbours, materials.rows, materials.shapes, scratch.shapes, out.shapes);
  add_liquid_steps(chunk, neighbours, materials, out);
}

bool mesh_chunk_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                       const MeshBorders& borders, const MeshMaterials& materials,
                       const DirtyLayers& dirty,
                       const std::array<DirtyLayers, kDirectionCount>& beyond,
                       ChunkMeshScratch& scratch, ChunkMesh& mesh) {
  const bool layers_only = mesh_rdm_layers(chunk, neighbours, borders, materials.cubes, dirty,
                                           beyond, scratch.cubes, mesh);
  mesh_shapes(chunk, neighbours, materials.rows, materials.shapes, scratch.shapes, mesh.shapes);
  add_liquid_steps(chunk, neighbours, materials, mesh);
  return layers_only;
}

}  // namespace runstone
