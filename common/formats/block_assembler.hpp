// The block assembler joins 16^3 blocks of another program's world to world chunks, from runs to
// runs. It has no voxel buffer, only one cursor per block.
#pragma once
#include <functional>
#include <span>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the same runs with every material i replaced by to[i]. Runs that became equal merge.
/// Requires every material of the chunk below to.size(). Cost: O(runs).
RunChunk with_materials(const RunChunk& chunk, std::span<const Material> to);

/// Returns a 16^3 block of the other world in AxisOrder::xyz with that world's material ids, or
/// null where there is none (it becomes empty). The pointer must stay valid until assemble_chunk()
/// returns.
using BlockLookup = std::function<const RunChunk*(ChunkCoord block)>;

/// Returns the world chunk of edge 16, 32, 64 or 128 at `at` in the grid of chunks of that edge, in
/// AxisOrder::xyz. Calls `lookup` once for each of its (edge / 16)^3 blocks. Cost: O(lines of the
/// blocks + runs).
RunChunk assemble_chunk(std::int32_t edge, ChunkCoord at, const BlockLookup& lookup);

}  // namespace runstone
