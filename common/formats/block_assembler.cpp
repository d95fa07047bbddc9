#include "common/formats/block_assembler.hpp"

#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// Reads one block line after line. A target chunk in the block's own axis order visits the lines
/// of each block in ascending index, so the cursor only moves forward.
class BlockCursor {
 public:
  explicit BlockCursor(const RunChunk* block) : block_(block) {}

  /// Appends the next line of 16 voxels.
  void take_line(RunBuilder& out) {
    if (block_ == nullptr) {
      out.append(kLuantiBlockEdge, kEmpty);
      return;
    }
    const std::uint32_t end = at_ + kLuantiBlockEdge;
    while (at_ < end) {
      const Run run = block_->runs[run_];
      const std::uint32_t stop = run.end < end ? run.end : end;
      out.append(stop - at_, run.material);
      at_ = stop;
      if (run.end == stop && stop < block_->volume()) ++run_;
    }
  }

 private:
  const RunChunk* block_;
  std::uint32_t at_ = 0;
  std::size_t run_ = 0;
};

}  // namespace

RunChunk with_materials(const RunChunk& chunk, std::span<const Material> to) {
  RunBuilder out(chunk.extent, chunk.order);
  chunk.runs.visit([&](auto runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      RUNSTONE_ASSERT(runs.material(i) < to.size());
      out.append_to(runs.end(i), to[runs.material(i)]);
    }
  });
  return out.finish();
}

RunChunk assemble_chunk(std::int32_t edge, ChunkCoord at, const BlockLookup& lookup) {
  RUNSTONE_ASSERT(edge == 16 || edge == 32 || edge == 64 || edge == 128);
  const std::int32_t side = edge / kLuantiBlockEdge;  // in blocks
  std::vector<BlockCursor> blocks;                    // x fastest, then y, then z
  blocks.reserve(static_cast<std::size_t>(side * side * side));
  // Most blocks of a world are uniform: sky and deep rock.
  bool uniform = true;
  Material only = kEmpty;
  for (std::int32_t z = 0; z < side; ++z) {
    for (std::int32_t y = 0; y < side; ++y) {
      for (std::int32_t x = 0; x < side; ++x) {
        const RunChunk* block = lookup({at.x * side + x, at.y * side + y, at.z * side + z});
        RUNSTONE_ASSERT(block == nullptr || (block->extent == Extent::cube(kLuantiBlockEdge) &&
                                             block->order == AxisOrder::xyz));
        const Material material = block == nullptr ? kEmpty : block->runs.material(0);
        if (blocks.empty()) only = material;
        uniform = uniform && material == only && (block == nullptr || block->is_uniform());
        blocks.emplace_back(block);
      }
    }
  }
  const Extent extent = Extent::cube(static_cast<unsigned>(edge));
  if (uniform) return uniform_chunk(extent, only);

  RunBuilder out(extent, AxisOrder::xyz);
  for (std::int32_t z = 0; z < edge; ++z) {
    for (std::int32_t y = 0; y < edge; ++y) {
      const std::int32_t row = side * (y / kLuantiBlockEdge + side * (z / kLuantiBlockEdge));
      for (std::int32_t x = 0; x < side; ++x)
        blocks[static_cast<std::size_t>(row + x)].take_line(out);
    }
  }
  return out.finish();
}

}  // namespace runstone
