#include "common/patterns/passing_voxels.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/patterns/column_slice.hpp"

namespace runstone {
namespace {

/// The voxels of one plane across z, as stretches along x that grow column by column.
class GrowingRows {
 public:
  GrowingRows(std::int32_t low, std::int32_t high, VoxelRows& out)
      : low_(low), open_(static_cast<std::size_t>(high - low)), out_(out) {}

  /// Adds voxels of the column at x and z. Requires columns of one z, with ascending x, until
  /// finish().
  void add(const HeightRange& range, std::int32_t x, std::int32_t z) {
    for (std::int32_t y = range.low; y < range.high; ++y) {
      RowStretch& part = open_[static_cast<std::size_t>(y - low_)];
      if (part.high == x && part.low < part.high) {
        ++part.high;
        continue;
      }
      put(part, y, z);
      part = {x, x + 1};
    }
  }
  void finish(std::int32_t z) {
    for (std::size_t i = 0; i < open_.size(); ++i)
      put(std::exchange(open_[i], {}), low_ + static_cast<std::int32_t>(i), z);
  }

 private:
  void put(const RowStretch& part, std::int32_t y, std::int32_t z) {
    if (part.low < part.high) out_.add(y, z, part);
  }

  const std::int32_t low_;
  std::vector<RowStretch> open_;  // by height
  VoxelRows& out_;
};

/// Adds the voxels of a part of a box. Returns the error if it ended early, or nullopt.
std::optional<FloodFault> add_passing(const VoxelBox& part, const VoxelBox& box,
                                      BoundFilter& filter, std::uint64_t& voxels_left,
                                      std::int32_t chunk_edge, const ChunkLookup& chunks,
                                      VoxelRows& out) {
  const auto columns =
      read_column_slice(slice_box(part, filter.reads_neighbours()), box, chunk_edge, chunks);
  if (!columns) return FloodFault::too_many_voxels;
  GrowingRows rows(part.min.y, part.max.y, out);
  for (std::int32_t z = part.min.z; z < part.max.z; ++z) {
    for (std::int32_t x = part.min.x; x < part.max.x; ++x) {
      if (columns->column(columns->index(x, z)).empty()) return FloodFault::missing_chunk;
      for (const HeightRange& range : filter.passing(*columns, x, z, {part.min.y, part.max.y})) {
        const auto count = static_cast<std::uint64_t>(range.high - range.low);
        if (count > voxels_left) return FloodFault::too_many_voxels;
        voxels_left -= count;
        rows.add(range, x, z);
      }
    }
    rows.finish(z);
  }
  return std::nullopt;
}

/// Returns true if all chunks of a box are known.
bool is_known(const VoxelBox& box, std::int32_t edge, const ChunkLookup& chunks) {
  const ChunkCoord first = chunk_of(box.min, edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  for (ChunkCoord at = first; at.z <= last.z; ++at.z) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.x = first.x; at.x <= last.x; ++at.x) {
        if (!chunks(at)) return false;
      }
    }
  }
  return true;
}

}  // namespace

Result<VoxelRows, FloodFault> passing_voxels(std::span<const VoxelBox> boxes, BoundFilter filter,
                                             std::uint64_t voxels_max, std::int32_t chunk_edge,
                                             const ChunkLookup& chunks) {
  VoxelRows out;
  std::uint64_t left = voxels_max;
  for (const VoxelBox& box : boxes) {
    // A box of the whole world ends here, before its columns are counted.
    if (!is_known(box, chunk_edge, chunks)) return failure(FloodFault::missing_chunk);
    VoxelBox part = box;
    for (part.min.z = box.min.z; part.min.z < box.max.z; part.min.z = part.max.z) {
      part.max.z = std::min(part.min.z + kColumnSliceEdge, box.max.z);
      for (part.min.x = box.min.x; part.min.x < box.max.x; part.min.x = part.max.x) {
        part.max.x = std::min(part.min.x + kColumnSliceEdge, box.max.x);
        if (const auto fault = add_passing(part, box, filter, left, chunk_edge, chunks, out))
          return failure(*fault);
      }
    }
  }
  out.join();
  return out;
}

}  // namespace runstone
