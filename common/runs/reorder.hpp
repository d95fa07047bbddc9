// Reordering of a chunk to the axis order that needs the fewest runs ("dynamic compression
// rotation", thesis 9.2). It uses no dense grid. A run of the new order starts where a voxel
// differs from its predecessor along the new fastest axis. Two cursors over the old runs, one a
// line or a layer behind the other, find each such place and skip equal stretches. Counting needs
// one layer of materials as scratch; reordering needs the starts of the new runs.
#pragma once
#include <array>
#include <cstdint>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the same voxels in another axis order. Cost: O(runs in + runs out + lines). Scratch is 4
/// bytes for each run made, before runs that meet at the end of a line merge.
RunChunk reorder(const RunChunk& chunk, AxisOrder order);

/// Returns the exact number of runs in each axis order, without making them. Cost: O(runs + outer
/// faces of the chunk).
std::array<std::uint32_t, kAxisOrderCount> runs_per_order(const RunChunk& chunk);

/// Returns the order with the fewest runs. Ties go to the lower order number.
AxisOrder cheapest_order(const RunChunk& chunk);

/// Returns the same voxels in their cheapest order. If the chunk has that order already, the only
/// cost is the count.
RunChunk in_cheapest_order(RunChunk chunk);

}  // namespace runstone
