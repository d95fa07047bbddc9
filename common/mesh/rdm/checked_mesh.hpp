// Checked meshing, for a host whose chunks come from data: what mesh_rdm() requires of its chunks
// is a result here.
#pragma once
#include <span>

#include "common/core/result.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"

namespace runstone {

/// Returns a table of visibilities. Fails with limit_exceeded if there are more entries than
/// materials can have, kMaterialCountMax.
Result<VisibilityTable> visibility_table(std::span<const Visibility> materials);

/// Makes the mesh of a chunk as mesh_rdm() does. Fails, and leaves `out` as it was, if
///   - the chunk or a neighbour is not valid, with the error of validate();
///   - a neighbour has other sides than the chunk where they touch, with bad_value. The offset is
///     the Direction of the neighbour.
/// Cost: that of mesh_rdm(), and O(runs of the neighbours).
Result<void> try_mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours,
                          const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out);

}  // namespace runstone
