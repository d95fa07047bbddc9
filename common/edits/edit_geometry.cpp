#include "common/edits/edit_geometry.hpp"

#include <array>

#include "common/core/assert.hpp"
#include "common/edits/ordered_shape.hpp"

namespace runstone {
namespace {

VoxelBox box_of_shape(const SetVoxel& shape) {
  return {shape.at, {shape.at.x + 1, shape.at.y + 1, shape.at.z + 1}};
}
VoxelBox box_of_shape(const FillBox& shape) { return shape.box; }
VoxelBox box_of_shape(const FillSphere& shape) {
  const std::int32_t r = shape.radius;
  const VoxelPos& c = shape.centre;
  return {{c.x - r, c.y - r, c.z - r}, {c.x + r + 1, c.y + r + 1, c.z + r + 1}};
}

// Voxels of a sphere: the rows of one quarter of its (x, y) disc, times the mirrors they have.
std::uint64_t sphere_voxels(std::int64_t r) {
  const std::int64_t reach = r * r + r;
  std::uint64_t count = 0;
  for (std::int64_t x = 0; x <= r; ++x) {
    std::int64_t half = r;
    for (std::int64_t y = 0; x * x + y * y <= reach; ++y) {
      while (half * half > reach - x * x - y * y) --half;
      const std::uint64_t mirrors = (x == 0 ? 1u : 2u) * (y == 0 ? 1u : 2u);
      count += mirrors * static_cast<std::uint64_t>(2 * half + 1);
    }
  }
  return count;
}

struct ChunkRange {
  ChunkCoord first, last;  // both included
};

ChunkRange chunk_range(const EditDescriptor& edit, std::int32_t edge) {
  RUNSTONE_ASSERT(edge == 16 || edge == 32 || edge == 64 || edge == 128);
  const VoxelBox box = bounding_box(edit);
  return {chunk_of(box.min, edge), chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge)};
}

}  // namespace

VoxelBox bounding_box(const EditDescriptor& edit) {
  return std::visit([](const auto& shape) { return box_of_shape(shape); }, edit.shape);
}

std::uint64_t voxel_count(const EditDescriptor& edit) {
  if (const auto* sphere = std::get_if<FillSphere>(&edit.shape)) return sphere_voxels(sphere->radius);
  const VoxelBox b = bounding_box(edit);
  return static_cast<std::uint64_t>(b.max.x - b.min.x) * static_cast<std::uint64_t>(b.max.y - b.min.y) *
         static_cast<std::uint64_t>(b.max.z - b.min.z);
}

bool touches(const EditDescriptor& edit, const VoxelBox& box) {
  if (box.empty()) return false;
  const auto* sphere = std::get_if<FillSphere>(&edit.shape);
  if (sphere == nullptr) return !intersect(bounding_box(edit), box).empty();
  // The voxel of the box nearest to the centre decides: distances are taken between voxel positions.
  const std::int64_t r = sphere->radius;
  const std::array<std::array<std::int64_t, 3>, 3> axes = {{{sphere->centre.x, box.min.x, box.max.x},
                                                            {sphere->centre.y, box.min.y, box.max.y},
                                                            {sphere->centre.z, box.min.z, box.max.z}}};
  std::int64_t squared = 0;
  for (const auto& [centre, min, max] : axes) {
    const std::int64_t d = std::clamp(centre, min, max - 1) - centre;
    if (d < -r || d > r) return false;  // also keeps the squares small
    squared += d * d;
  }
  return squared <= r * r + r;
}

std::vector<ChunkCoord> touched_chunks(const EditDescriptor& edit, std::int32_t edge) {
  const auto [first, last] = chunk_range(edit, edge);
  std::vector<ChunkCoord> out;
  for (ChunkCoord c{first.x, 0, 0}; c.x <= last.x; ++c.x) {
    for (c.y = first.y; c.y <= last.y; ++c.y) {
      for (c.z = first.z; c.z <= last.z; ++c.z) {
        if (touches(edit, box_of(c, edge))) out.push_back(c);
      }
    }
  }
  return out;
}

std::uint64_t touched_chunks_bound(const EditDescriptor& edit, std::int32_t edge) {
  const auto [first, last] = chunk_range(edit, edge);
  return static_cast<std::uint64_t>(last.x - first.x + 1) * static_cast<std::uint64_t>(last.y - first.y + 1) *
         static_cast<std::uint64_t>(last.z - first.z + 1);
}

void append_spans(const EditDescriptor& edit, VoxelPos origin, Extent extent, AxisOrder order,
                  std::vector<IndexSpan>& out) {
  const auto shape = clip(edit, origin, extent, order);
  if (shape) append_spans(*shape, ordered(extent, order), out);
}

}  // namespace runstone
