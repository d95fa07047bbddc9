// The mesh of the voxels that are no cubes. It reads runs: a run of a shape gives one quad for each
// face that joins along the fastest axis, and one a voxel for each that does not. Equal strips of
// neighbouring lines and layers are joined afterwards. The sweep of the cubes (rdm_mesher.hpp)
// takes these voxels for empty ones, so worlds of cubes pay nothing.
#pragma once
#include <cstddef>
#include <memory>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// The buffers that calls reuse, so that a steady state allocates nothing. A scratch belongs to one
/// thread, and callers do not use its contents.
class ShapeScratch {
 public:
  ShapeScratch();
  ~ShapeScratch();
  ShapeScratch(ShapeScratch&&) noexcept;
  ShapeScratch& operator=(ShapeScratch&&) noexcept;
  struct State;
  State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// The faces of shapes that one chunk shows. A chunk with more, which only shapes of very many
/// faces reach, shows the first ones in the order of its runs.
inline constexpr std::size_t kShapeQuadsMax = std::size_t{1} << 21;

/// Replaces `out` by the quads of the shapes of `chunk`. Returns false if the chunk has more than
/// kShapeQuadsMax faces, of which `out` has the first ones.
///   - A face on the border of its voxel is hidden by an opaque cube before it, by an opaque shape
///     whose side fills all that the face covers, and by a voxel of its own material whose side
///     does. Other faces are never hidden.
///   - A cube is not hidden by a shape.
///   - Equal faces of voxels that lie side by side are one quad where they join: along u if they
///     go from 0 to 16 there, and along v alike. The planes of plants do not join.
///   - A shape whose material is empty has no faces.
///
/// `visibility` is that of the materials' rows, in which shapes are not empty. Requires valid
/// chunks, and neighbours as mesh_rdm() does; those that are missing hide nothing. The same input
/// gives the same quads in the same order. Another axis order gives the same faces, which may be
/// joined to other quads. Thread: any, with one scratch each. Cost:
///   - O(runs) if the chunk has no shape, and O(1) if no material has one;
///   - otherwise O(runs + voxels of shapes x their faces), and O(runs of the lines beside them);
///   - for each border that shapes touch, a layer of the neighbour or O(log runs) a voxel.
bool mesh_shapes(const RunChunk& chunk, const MeshNeighbours& neighbours,
                 const VisibilityTable& visibility, const ShapeTable& shapes, ShapeScratch& scratch,
                 ShapeQuads& out);

}  // namespace runstone
