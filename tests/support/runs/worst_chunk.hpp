// worst_chunk: a chunk that takes the most memory for its size. No two voxels side by side are
// equal, so it has a run, and three quads, for each voxel.
#pragma once
#include <cstdint>
#include <utility>

#include "common/runs/chunk.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::test {

/// A chessboard of `material` and air, at `version`.
inline Chunk worst_chunk(unsigned edge, Version version = {}, Material material = 1) {
  const Extent extent = Extent::cube(edge);
  RunBuilder builder(extent, AxisOrder::xyz);
  for (VoxelIndex i = 0; i < extent.volume(); ++i) {
    const LocalPos p = pos_of(i, extent, AxisOrder::xyz);
    builder.append(1, (p.x + p.y + p.z) % 2 == 0 ? material : kEmpty);
  }
  Chunk chunk;
  chunk.voxels = builder.finish();
  chunk.voxels.runs.shrink_to_fit();
  chunk.version = version;
  chunk.digest = digest_of(chunk.voxels);
  return chunk;
}

}  // namespace runstone::test
