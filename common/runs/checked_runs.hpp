// Checked calls on runs, for a host whose sizes and places come from data: what the calls of
// run_chunk.hpp and cut.hpp require is a result here. Inner loops use those.
#pragma once
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the extent of a chunk. Fails with bad_value if a side is outside kSideMin .. kSideMax.
Result<Extent> chunk_extent(unsigned x, unsigned y, unsigned z);

/// Sets voxels as fill() does. Returns true if any voxel changed. Fails with bad_value if `count`
/// is 0 or the voxels reach behind the end of the chunk, which then stays as it was. Requires a
/// valid chunk.
Result<bool> try_fill(RunChunk& chunk, VoxelIndex first, std::uint32_t count, Material material,
                      EditArea* area = nullptr);

/// Returns the material at a local position as material_at() does. Fails with bad_value if the
/// position is outside the chunk. Requires a valid chunk.
Result<Material> try_material_at(const RunChunk& chunk, LocalPos at);

/// Copies a cuboid as cut() does. Fails with bad_value if the cuboid has an empty side or reaches
/// out of the chunk. Requires a valid chunk.
Result<RunChunk> try_cut(const RunChunk& chunk, LocalPos first, Extent extent,
                         std::uint8_t mirrored = 0);

}  // namespace runstone
