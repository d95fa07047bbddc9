// Dynamic compression rotation (thesis 9.2): the same voxels in the axis order that needs the fewest runs.
// No dense grid: at most one layer of materials is held at a time.
#pragma once
#include <array>
#include <cstdint>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The same voxels in another axis order. O(volume) time, O(one layer) scratch.
RunChunk reorder(const RunChunk& chunk, AxisOrder order);

/// Number of runs in each axis order, without making them. Exact.
std::array<std::uint32_t, kAxisOrderCount> runs_per_order(const RunChunk& chunk);

/// Order with the fewest runs; ties go to the lower order number.
AxisOrder cheapest_order(const RunChunk& chunk);

/// The same voxels in their cheapest order. Does nothing beyond the count when that is the order already.
RunChunk in_cheapest_order(RunChunk chunk);

}  // namespace runstone
