// The mesh of the voxels that are no cubes. It reads runs: a run of a shape gives one quad for each
// face that joins along the fastest axis, and one a voxel for each that does not. The sweep of the
// cubes (rdm_mesher.hpp) takes these voxels for empty ones, so worlds of cubes pay nothing.
#pragma once
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// Replaces `out` by the quads of the shapes of `chunk`.
///   - A face on the border of its voxel is hidden by an opaque cube before it, by an opaque shape
///     whose side fills all that the face covers, and by a voxel of its own material whose side
///     does. Other faces are never hidden.
///   - A cube is not hidden by a shape.
///   - Equal faces of voxels that lie side by side are one quad where they join: along u if they
///     go from 0 to 16 there, and along v alike.
/// `visibility` is that of the materials' rows, in which shapes are not empty. Requires valid
/// chunks, and neighbours as mesh_rdm() does; those that are missing hide nothing. Thread: any.
/// Cost: O(runs) if the chunk has no shape; otherwise O(runs + voxels of shapes x their faces), and
/// a lookup of O(log runs) for each voxel beside a shape on its border.
void mesh_shapes(const RunChunk& chunk, const MeshNeighbours& neighbours,
                 const VisibilityTable& visibility, const ShapeTable& shapes, ShapeQuads& out);

}  // namespace runstone
