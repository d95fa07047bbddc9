// Geometry of edits: which voxels, which chunks, and which stretches of a chunk's index order they cover.
// Nobody visits voxels one by one. All integers.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Smallest box that holds the geometry (mask ignored). O(1); stroke: O(points).
VoxelBox bounding_box(const EditDescriptor& edit);

/// Smallest box that holds the capsule from point `i` of the stroke to the next one.
VoxelBox segment_box(const FillStroke& stroke, std::size_t i);

/// Voxels that the geometry counts for where edits are limited, mask ignored: never fewer than it has. Exact
/// but for strokes, whose segments are counted each for itself, from above (docs/edit-log.md), so that the
/// count bounds their work too. Of a paste the touched cells. Sphere: O(r^2). Stroke: O(points).
std::uint64_t counted_voxels(const EditDescriptor& edit);

/// Whether the geometry has a voxel in this box. Exact. O(1); stroke: O(points), and O(lines of the box that
/// a segment meets) where one comes close; paste: O(lines of the clipboard in the box * log runs).
bool touches(const EditDescriptor& edit, const VoxelBox& box);

/// Chunks (lod 0) in which the geometry has a voxel, ascending by x, then y, then z. This order is part of
/// the protocol: a commit lists one previous version per touched chunk in it. `edge`: 16, 32, 64 or 128.
std::vector<ChunkCoord> touched_chunks(const EditDescriptor& edit, std::int32_t edge);
/// The same into `out`, whose room is used again.
void touched_chunks(const EditDescriptor& edit, std::int32_t edge, std::vector<ChunkCoord>& out);

/// Number of chunks touched_chunks() would list, counted by the bounding box, for a stroke by the bounding
/// boxes of its segments added up: an upper bound for limits, and for the work of listing them. O(1); stroke:
/// O(points).
std::uint64_t touched_chunks_bound(const EditDescriptor& edit, std::int32_t edge);

/// Half-open stretch of a flattened chunk.
struct IndexSpan {
  VoxelIndex first = 0, last = 0;
  friend bool operator==(const IndexSpan&, const IndexSpan&) = default;
};

/// Appends the stretches of the chunk at `origin` that the geometry covers: ascending, disjoint, not adjacent
/// (whole lines and layers join into one). O(lines covered); stroke and paste: O(n log n) of the rows of their
/// parts.
void append_spans(const EditDescriptor& edit, VoxelPos origin, Extent extent, AxisOrder order,
                  std::vector<IndexSpan>& out);

}  // namespace runstone
