#include "tests/support/formats/foreign_cells.hpp"

#include <utility>

#include "common/core/assert.hpp"

namespace runstone::test {

Result<ForeignCells> read_foreign_cells(Result<ForeignInfo> (*read)(ByteView record,
                                                                    const PieceSink& sink),
                                        ByteView file) {
  ForeignCells out;
  std::uint64_t volume = 0;
  auto info = read(file, [&](ForeignPiece&& piece) -> Result<void> {
    const RunChunk& voxels = piece.voxels;
    RUNSTONE_ASSERT(validate_runs(voxels).has_value());
    const VoxelPos low = piece.origin;
    const VoxelBox box{low,
                       {low.x + voxels.extent.x, low.y + voxels.extent.y, low.z + voxels.extent.z}};
    out.box = bounding_box(out.box, box);
    ++out.pieces;
    volume += voxels.volume();
    for (std::size_t run = 0; run < voxels.runs.size(); ++run) {
      const Material material = voxels.runs.material(run);
      RUNSTONE_ASSERT(material <= piece.blocks.size());
      if (material == kEmpty || volume > (1u << 20)) continue;
      const ForeignBlock& block = piece.blocks[material - 1u];
      const std::string text =
          block.states.empty() ? block.name : block.name + '[' + block.states + ']';
      for (std::uint32_t i = voxels.runs.begin(run); i < voxels.runs.end(run); ++i) {
        const LocalPos at = pos_of(i, voxels.extent, voxels.order);
        out.blocks[{low.x + at.x, low.y + at.y, low.z + at.z}] = text;
      }
    }
    return {};
  });
  if (!info) return failure(info.error());
  out.info = *std::move(info);
  return out;
}

}  // namespace runstone::test
