#include <array>

#include "common/mesh/rdm/layer_mesher.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/rdm/touched_layers.hpp"

namespace runstone {

bool mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const VisibilityTable& visibility, const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh) {
  return mesh_rdm_layers(chunk, neighbours, MeshBorders{}, visibility, dirty, beyond, scratch,
                         mesh);
}

bool mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const MeshBorders& borders, const VisibilityTable& visibility,
                     const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh) {
  const rdm::TouchedLayers touched(chunk, neighbours, dirty, beyond);
  const auto observer = [](rdm::LayerStep) {};
  rdm::LayerMesher mesher(chunk, neighbours, borders, visibility, scratch.state(), mesh, observer);
  if (!mesher.pays(touched)) {
    mesh_rdm(chunk, neighbours, borders, visibility, scratch, mesh);
    return false;
  }
  mesher.run(touched);
  return true;
}

}  // namespace runstone
