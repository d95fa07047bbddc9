// Meshes one direction of one layer on its own, from decoded layers: the faces of a layer are a problem in
// two dimensions that no other layer has a part in. Same strips, same quads, same order as the sweep makes.
// Internal to rdm.
#pragma once
#include <cstdint>
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/layer_voxels.hpp"
#include "common/mesh/rdm/quad_shape.hpp"

namespace runstone::rdm {

template <class Row>
struct LayerFaces {
  const LayerVoxels<Row>* own = nullptr;     // whose faces
  const LayerVoxels<Row>* beyond = nullptr;  // which hides them
  std::uint32_t bits = 0, rows = 0;
  std::uint32_t layer = 0;
  QuadShape shape;
};

/// Appends the quads of the layer to the pass each belongs to. O(rows + quads) and a comparison a voxel.
void mesh_layer(const LayerFaces<Row64>& faces, std::vector<Quad>& opaque, std::vector<Quad>& transparent);
void mesh_layer(const LayerFaces<Row128>& faces, std::vector<Quad>& opaque, std::vector<Quad>& transparent);

}  // namespace runstone::rdm
