// Geometry of edits: which voxels, which chunks, and which stretches of a chunk's index order they cover.
// Nobody visits voxels one by one. All integers.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/edit_descriptor.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Smallest box that holds the geometry (mask ignored).
VoxelBox bounding_box(const EditDescriptor& edit);

/// Voxels in the geometry, mask ignored: exact. Sphere: O(r^2).
std::uint64_t voxel_count(const EditDescriptor& edit);

/// Whether the geometry has a voxel in this box. Exact, O(1).
bool touches(const EditDescriptor& edit, const VoxelBox& box);

/// Chunks (lod 0) in which the geometry has a voxel, ascending by x, then y, then z. This order is part of
/// the protocol: a commit lists one previous version per touched chunk in it. `edge`: 16, 32, 64 or 128.
std::vector<ChunkCoord> touched_chunks(const EditDescriptor& edit, std::int32_t edge);

/// Number of chunks touched_chunks() would list, counted by the bounding box: an upper bound for limits.
/// O(1).
std::uint64_t touched_chunks_bound(const EditDescriptor& edit, std::int32_t edge);

/// Half-open stretch of a flattened chunk.
struct IndexSpan {
  VoxelIndex first = 0, last = 0;
  friend bool operator==(const IndexSpan&, const IndexSpan&) = default;
};

/// Appends the stretches of the chunk at `origin` that the geometry covers: ascending, disjoint, not adjacent
/// (whole lines and layers join into one). O(lines covered).
void append_spans(const EditDescriptor& edit, VoxelPos origin, Extent extent, AxisOrder order,
                  std::vector<IndexSpan>& out);

}  // namespace runstone
