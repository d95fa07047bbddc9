// Dynamic compression rotation (thesis 9.2): the same voxels in the axis order that needs the fewest runs.
// No dense grid. A run of the new order starts where a voxel differs from its predecessor along the new
// fastest axis; two cursors over the old runs, one a line or a layer behind the other, meet every such place,
// and skip what is equal. Counting holds one layer of materials; reordering holds the starts of the new runs.
#pragma once
#include <array>
#include <cstdint>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The same voxels in another axis order. O(runs in + runs out + lines) time; scratch is 4 bytes for each run
/// made, before runs that meet at the end of a line merge.
RunChunk reorder(const RunChunk& chunk, AxisOrder order);

/// Number of runs in each axis order, without making them. Exact. O(runs + outer faces of the chunk).
std::array<std::uint32_t, kAxisOrderCount> runs_per_order(const RunChunk& chunk);

/// Order with the fewest runs; ties go to the lower order number.
AxisOrder cheapest_order(const RunChunk& chunk);

/// The same voxels in their cheapest order. Does nothing beyond the count when that is the order already.
RunChunk in_cheapest_order(RunChunk chunk);

}  // namespace runstone
