// Dense expansion: a buffer with a material per voxel of more than one layer. It is for oracles,
// tools and reference meshers only. Every expansion is counted. Server and client work on runs from
// end to end, so the counter stays zero there.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the number of dense buffers made in this process so far. Thread: any.
std::uint64_t dense_expansions();
/// Counts one expansion, for code that makes dense voxels itself (reference meshers, blocks of
/// another format).
void count_dense_expansion();

/// Returns one material per voxel in the chunk's own index order. The expansion is counted. Cost:
/// O(volume).
std::vector<Material> to_dense(const RunChunk& chunk);

/// Returns the runs of a dense buffer in index order `order`. Fails with bad_value if no chunk may
/// have the extent, the order is unknown, or the number of voxels is not the volume. It is not
/// counted, because the caller already counted its buffer. Cost: O(volume).
Result<RunChunk> from_dense(Extent extent, AxisOrder order, std::span<const Material> voxels);

}  // namespace runstone
