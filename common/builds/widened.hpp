// Widening: cells with untouched cells around them. Internal to builds.
#pragma once
#include "common/core/coords.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns `cells`, which lie at `part`, with the cells of number 0 that fill `box`. Requires `part`
/// inside `box`, and sides of `box` up to kSideMax. Cost: O(runs + lines of the part).
RunChunk widened(const RunChunk& cells, const VoxelBox& part, const VoxelBox& box);

}  // namespace runstone
