// Geometry of edits: the voxels, the chunks and the stretches of a chunk's index order that they
// cover. No function visits voxels one by one. All numbers are integers.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Returns the smallest box that holds the geometry, mask ignored. An edit without voxels has the
/// empty box at the lowest corner of the world, unless it protects ground: then it has that box, so
/// that the log can be searched for it. Cost: O(1); stroke: O(points).
VoxelBox bounding_box(const EditDescriptor& edit);

/// Returns the smallest box that holds the capsule from point `i` of the stroke to the next one.
VoxelBox segment_box(const FillStroke& stroke, std::size_t i);

/// Returns the number of voxels that limits count for the geometry, mask ignored. It is never below
/// the true number. It is exact except for strokes: their segments are counted one by one, from
/// above (docs/edit-log.md), so the count also bounds their work. For a paste it is the number of
/// touched cells; for an edit without voxels, 0. Cost: O(1); sphere: O(r^2); stroke: O(points).
std::uint64_t counted_voxels(const EditDescriptor& edit);

/// Returns true if the geometry has a voxel in this box. The answer is exact. Cost: O(1); stroke:
/// O(points), and O(lines of the box that a segment meets) where one is close; paste: O(lines of
/// the clipboard in the box * log runs).
bool touches(const EditDescriptor& edit, const VoxelBox& box);

/// Returns the chunks (lod 0) in which the geometry has a voxel, ascending by x, then y, then z.
/// This order is part of the protocol: a commit lists one previous version per touched chunk in it.
/// `edge`: 16, 32, 64 or 128.
std::vector<ChunkCoord> touched_chunks(const EditDescriptor& edit, std::int32_t edge);
/// Replaces `out` by the touched chunks and reuses its memory.
void touched_chunks(const EditDescriptor& edit, std::int32_t edge, std::vector<ChunkCoord>& out);

/// Returns an upper bound for the number of touched_chunks(): the number of chunks that the
/// bounding box meets; for a stroke, the sum of these numbers over its segments. It serves limits,
/// and bounds the work of listing the chunks. Cost: O(1); stroke: O(points).
std::uint64_t touched_chunks_bound(const EditDescriptor& edit, std::int32_t edge);

/// A half-open stretch of a flattened chunk.
struct IndexSpan {
  VoxelIndex first = 0, last = 0;
  friend bool operator==(const IndexSpan&, const IndexSpan&) = default;
};

/// Appends the stretches of the chunk at `origin` that the geometry covers. They ascend, are
/// disjoint and not adjacent (whole lines and layers join into one). Cost: O(lines covered); stroke
/// and paste: O(n log n) of the rows of their parts.
void append_spans(const EditDescriptor& edit, VoxelPos origin, Extent extent, AxisOrder order,
                  std::vector<IndexSpan>& out);

}  // namespace runstone
