// TouchedLayers: the layers of a chunk whose faces an edit may have changed. Internal to rdm.
#pragma once
#include <array>
#include <bitset>

#include "common/core/coords.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::rdm {

using LayerSet = std::bitset<kSideMax>;

struct TouchedLayers {
  /// Takes what mesh_rdm_layers() takes.
  TouchedLayers(const RunChunk& chunk, const MeshNeighbours& neighbours, const DirtyLayers& dirty,
                const std::array<DirtyLayers, kDirectionCount>& beyond);

  /// The layers with faces to mesh again, by Direction: the layers with changed voxels, and the
  /// layers whose faces point at changed voxels.
  std::array<LayerSet, kDirectionCount> faces;
  /// The layers of the slowest axis in which a voxel changed, or beside which a voxel of a
  /// neighbour changed.
  LayerSet slow;
};

}  // namespace runstone::rdm
