// Run Directional Meshing straight from runs (thesis chapter 7.3, with the culling and merging it left open):
// six directions, hidden faces culled inside the chunk and across its borders, strips merged along the line,
// then across lines and layers. No dense grid.
#pragma once
#include <array>
#include <memory>

#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/chunk_borders.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The six chunks around one, by Direction, in any axis order, with equal sides where they touch. A null one
/// is "missing": its voxels count as empty, so the faces at the edge of the view are drawn.
using MeshNeighbours = std::array<const RunChunk*, kDirectionCount>;

/// What the holders of those chunks keep of their sides, by Direction as well; null where nothing is kept.
using MeshBorders = std::array<const ChunkBorders*, kDirectionCount>;

/// Buffers reused between calls; steady state allocates nothing. Belongs to one thread. Opaque to callers.
class RdmScratch {
 public:
  RdmScratch();
  ~RdmScratch();
  RdmScratch(RdmScratch&&) noexcept;
  RdmScratch& operator=(RdmScratch&&) noexcept;
  struct State;
  State& state() { return *state_; }
  /// Meshes a row at a time, without vector instructions: same quads, for tests and measurements.
  void use_plain_path(bool plain);

 private:
  std::unique_ptr<State> state_;
};

/// Replaces `out` by the mesh of `chunk`. A face belongs to the chunk of its solid voxel.
/// Quads of a layer cover each exposed face exactly once, never another, never two materials.
/// The same input gives the same quads in the same order; another axis order gives the same faces, but may
/// cut them into other quads. Requires valid chunks, and neighbours with the chunk's sides across their
/// direction. Cost: O(runs + quads of the chunk + runs of the neighbours), a pass over each layer that is not
/// like the one before it, 64 voxels at a time, and a layer for each neighbour whose border has to be
/// transposed; a uniform chunk among uniform ones is O(1). Any thread, one scratch each.
void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours,
              const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out);

/// The same mesh with the borders of neighbours that are kept, which must be those of `neighbours` as they
/// are now: their runs are read only where transparent voxels may meet. If `chunk_borders` is there, it becomes what
/// chunk_borders->read(chunk, visibility) would make it, for little, since the sweep comes by all of it.
void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours, const MeshBorders& borders,
              const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out,
              ChunkBorders* chunk_borders = nullptr);

/// Meshes again what an edit touched: `mesh` is that of the chunk and its neighbours before, `dirty` the
/// layers in which a voxel of the chunk changed since (ApplyResult::dirty), and `beyond` the same of each
/// neighbour; what lies behind the layer that touches the chunk does not matter. Equal to mesh_rdm(), quad
/// for quad. The chunk's axis order must be the one it was meshed in. In each layer, the rows in which a
/// voxel may have changed are decoded, and joined anew with the quads above and below them. O(rows * (line +
/// log runs + quads of the layer) + quads moved); where that would cost more, it is mesh_rdm(). Allocates
/// nothing in a steady state. Returns whether only layers were meshed. Any thread, one scratch each.
bool mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const VisibilityTable& visibility, const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh);

}  // namespace runstone
