// Run Directional Meshing from runs (thesis 7.3; culling and merging, which the thesis left open,
// are included). It meshes six directions without a dense grid. Hidden faces are culled inside the
// chunk and across its borders. Strips are merged along the line, then across lines and layers.
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

/// The six chunks around a chunk, by Direction, in any axis order, with equal sides where they
/// touch. A missing chunk is null. Its voxels count as empty, so the faces at the edge of the view
/// are drawn.
using MeshNeighbours = std::array<const RunChunk*, kDirectionCount>;

/// The kept borders of those chunks, by Direction. A border that is not kept is null.
using MeshBorders = std::array<const ChunkBorders*, kDirectionCount>;

/// The buffers that calls reuse, so that a steady state allocates nothing. A scratch belongs to one
/// thread, and callers do not use its contents.
class RdmScratch {
 public:
  RdmScratch();
  ~RdmScratch();
  RdmScratch(RdmScratch&&) noexcept;
  RdmScratch& operator=(RdmScratch&&) noexcept;
  struct State;
  State& state() { return *state_; }
  /// Makes later calls mesh one row at a time, without vector instructions. The quads do not
  /// change. It is for tests and measurements.
  void use_plain_path(bool plain);

 private:
  std::unique_ptr<State> state_;
};

/// Replaces `out` by the mesh of `chunk`. A face belongs to the chunk of its solid voxel. The quads
/// of a layer cover each exposed face exactly once, no other face, and never two materials. The
/// same input gives the same quads in the same order. Another axis order gives the same faces,
/// which may be cut into other quads. Requires valid chunks, and neighbours with the chunk's sides
/// across their direction. Thread: any, with one scratch each. Cost:
///   - O(runs + quads of the chunk + runs of the neighbours);
///   - a pass over each layer that differs from the previous one, 64 voxels at a time;
///   - a layer for each neighbour whose border has to be transposed;
///   - O(1) for a uniform chunk among uniform ones.
void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours,
              const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out);

/// Makes the mesh with kept borders of neighbours. The runs of such a neighbour are not read,
/// except the single run of a uniform one. Requires borders that match `neighbours` as they are
/// now. If `chunk_borders` is not null, it becomes the result of chunk_borders->read(chunk,
/// visibility). That costs little, because the sweep visits all voxels of the chunk anyway.
void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours, const MeshBorders& borders,
              const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out,
              ChunkBorders* chunk_borders = nullptr);

/// Meshes again the parts that an edit touched. The quads are equal to those of mesh_rdm(), in the
/// same order.
///   - `mesh` is the mesh of the chunk and its neighbours before the edit, in the chunk's present
///     axis order.
///   - `dirty` are the layers in which a voxel of the chunk changed since. A holder whose chunks
///     change by apply_stack() only passes the union of ApplyResult::dirty. The client compares the
///     runs instead (layer_diff.hpp), because its shown runs also change by snapshots and by
///     predictions that are withdrawn.
///   - `beyond` are the layers of each neighbour in which a voxel changed since. Only its layer
///     that touches the chunk matters.
///
/// Sweeps over the layers of the slowest axis in which a voxel changed, and over the layers beside
/// these. Joins the new quads with the quads before and behind. Calls mesh_rdm() where that costs
/// less. Returns true if only layers were meshed. A steady state allocates nothing. Thread: any,
/// with one scratch each. Cost: O(runs of these layers + quads of the touched layers + quads that
/// move), and what mesh_rdm() takes for the borders of the touched sides.
bool mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const VisibilityTable& visibility, const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh);

/// Meshes layers with kept borders of neighbours. The runs of such a neighbour are not read, except
/// the single run of a uniform one. Requires borders that match `neighbours` as they are now.
bool mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const MeshBorders& borders, const VisibilityTable& visibility,
                     const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh);

}  // namespace runstone
