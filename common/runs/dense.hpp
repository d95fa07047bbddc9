// Dense expansion: the form Runstone exists to avoid. For oracles, tools and reference meshers only.
// Every call is counted; the counter is zero on the server's and the client's main path (invariant 1).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Number of dense buffers made in this process so far. Any thread.
std::uint64_t dense_expansions();
/// For code that keeps dense voxels of its own (reference meshers, a foreign format's block).
void count_dense_expansion();

/// One material per voxel in the chunk's own index order. Counted. O(volume).
std::vector<Material> to_dense(const RunChunk& chunk);

/// Runs of a dense buffer in index order `order`. Requires voxels.size() == volume. Not counted: the caller's
/// buffer was, if it is one. O(volume).
RunChunk from_dense(Extent extent, AxisOrder order, std::span<const Material> voxels);

}  // namespace runstone
