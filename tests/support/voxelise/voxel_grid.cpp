#include "tests/support/voxelise/voxel_grid.hpp"

#include <tuple>
#include <utility>

namespace runstone::test {

Result<VoxelGrid> voxel_grid(const Model& model, const VoxeliseOptions& options,
                             const ParallelFor& parallel_for) {
  VoxelGrid out;
  std::vector<VoxelPiece> pieces;
  auto done = voxelise(
      model, options,
      [&](VoxelPiece&& piece) -> Result<void> {
        pieces.push_back(std::move(piece));
        return {};
      },
      parallel_for);
  if (!done) return failure(done.error());
  out.result = *std::move(done);
  const VoxelPos s = out.result.sides;
  out.cells.assign(
      static_cast<std::size_t>(s.x) * static_cast<std::size_t>(s.y) * static_cast<std::size_t>(s.z),
      kEmpty);
  std::uint64_t count = 0;
  const VoxelPiece* last = nullptr;
  for (const VoxelPiece& piece : pieces) {
    const VoxelPos o = piece.origin;
    if (!validate_runs(piece.voxels)) return fail(ErrorCode::broken_invariant, "runs of a piece");
    if (is_empty(piece.voxels)) return fail(ErrorCode::broken_invariant, "an empty piece");
    if (last != nullptr &&
        std::tuple(last->origin.z, last->origin.y, last->origin.x) >= std::tuple(o.z, o.y, o.x))
      return fail(ErrorCode::broken_invariant, "the order of the pieces");
    last = &piece;
    const Extent e = piece.voxels.extent;
    if (o.x + e.x > s.x || o.y + e.y > s.y || o.z + e.z > s.z)
      return fail(ErrorCode::broken_invariant, "a piece outside the box");
    std::uint32_t index = 0;
    for (std::size_t run = 0; run < piece.voxels.runs.size(); ++run) {
      const Material material = piece.voxels.runs.material(run);
      for (; index < piece.voxels.runs.end(run); ++index) {
        const LocalPos at = pos_of(index, e, piece.voxels.order);
        if (material == kEmpty) continue;
        if (material > out.result.colours.size())
          return fail(ErrorCode::broken_invariant, "the number of a colour");
        ++count;
        out.cells[static_cast<std::size_t>(o.x + at.x + s.x * (o.y + at.y + s.y * (o.z + at.z)))] =
            material;
      }
    }
  }
  if (count != out.result.voxels) return fail(ErrorCode::broken_invariant, "the number of voxels");
  return out;
}

}  // namespace runstone::test
