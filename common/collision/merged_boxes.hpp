// Merged boxes: the solid voxels of a chunk as few boxes, for physics engines. Quads of a mesh make
// poor colliders: a body catches on the edges where quads meet, and a surface has no inside. The
// boxes are merged greedily from runs, in three steps:
//   - runs of solid materials that follow each other become rows: stretches of one line;
//   - equal rows of lines that follow each other in a layer become rectangles;
//   - equal rectangles of layers that follow each other become boxes (slabs).
//
// No step looks at a voxel. The greedy result is not the smallest number of boxes. An axis order
// with fewer runs mostly gives fewer boxes.
// Source: thesis 9.3 names colliders from merged runs as an application.
#pragma once
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/collision/material_set.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// A half-open, non-empty box of voxels of one chunk, by Axis. Coordinates are local, 0 .. 128.
struct MergedBox {
  std::array<std::uint8_t, 3> min{}, max{};
  friend auto operator<=>(const MergedBox&, const MergedBox&) = default;
};

/// No chunk needs more boxes: the worst case is a checkerboard of 128³ voxels.
inline constexpr std::size_t kMergedBoxesMax = kVolumeMax / 2;

/// Replaces `out` by boxes that cover each voxel of `solid` in the chunk exactly once, and no other
/// voxel. They ascend by their first voxel in the chunk's axis order, so the same chunk in the same
/// order gives the same boxes. Shapes count as their whole voxel. Fails with limit_exceeded if more
/// than `boxes_max` boxes are needed; `out` is then empty, and the work has ended at the layer in
/// which the limit was passed. Requires a valid chunk. Thread: any. Cost: O(runs + rows), memory
/// O(rows of two layers + boxes).
Result<void> merge_boxes(const RunChunk& chunk, const MaterialSet& solid, std::size_t boxes_max,
                         std::vector<MergedBox>& out);

}  // namespace runstone
