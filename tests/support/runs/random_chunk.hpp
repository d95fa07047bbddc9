// Seeded random chunks for property tests: all axis orders, few and many materials, and shapes from
// one single run to a run per voxel. They are streamed into a RunBuilder, so they count no dense
// expansion.
#pragma once
#include "common/core/hash.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::test {

/// Returns sides 8 .. side_max, mostly small, so that tests are fast. Requires 8 <= side_max <=
/// 128.
Extent random_extent(SplitMix64& rng, unsigned side_max = 40);

AxisOrder random_order(SplitMix64& rng);

/// The arrangement of the voxels of a random chunk.
enum class ChunkShape { uniform, layered, columns, boxes, spheres, speckled, noise, checkerboard };
inline constexpr int kShapeCount = 8;

/// Draws from `materials` ids, among them 0, the empty one. Requires 1 <= materials <= 65,536.
RunChunk random_chunk(SplitMix64& rng, Extent extent, AxisOrder order, unsigned materials,
                      ChunkShape shape);
/// Draws any shape.
RunChunk random_chunk(SplitMix64& rng, Extent extent, AxisOrder order, unsigned materials);
/// Draws any shape and order over sides 8 .. side_max.
RunChunk random_chunk(SplitMix64& rng, unsigned side_max, unsigned materials);
/// Draws any shape, order and materials over sides 8 .. 40; one chunk in thirty-two reaches up to
/// 128.
RunChunk random_chunk(SplitMix64& rng);

}  // namespace runstone::test
