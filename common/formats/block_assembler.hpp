// Putting 16^3 blocks of a foreign world together to world chunks, runs to runs: no voxel buffer, only a
// cursor per block.
#pragma once
#include <functional>
#include <span>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The same runs with every material i replaced by to[i]; what became equal merges. Requires every material
/// of the chunk below to.size(). O(runs).
RunChunk with_materials(const RunChunk& chunk, std::span<const Material> to);

/// A 16^3 block of the foreign world in AxisOrder::xyz with the world's own material ids, or null where there
/// is none (it becomes empty). The pointer must stay valid until assemble_chunk() returns.
using BlockLookup = std::function<const RunChunk*(ChunkCoord block)>;

/// The world chunk of edge 16, 32, 64 or 128 at `at` in the grid of chunks of that edge, in AxisOrder::xyz.
/// Calls `lookup` once for each of its (edge / 16)^3 blocks. O(lines of the blocks + runs).
RunChunk assemble_chunk(std::int32_t edge, ChunkCoord at, const BlockLookup& lookup);

}  // namespace runstone
