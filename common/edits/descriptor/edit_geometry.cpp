#include "common/edits/descriptor/edit_geometry.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/ordered_shape.hpp"
#include "common/edits/descriptor/placed_clipboard.hpp"

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
VoxelBox box_of_shape(const FillStroke& shape) {
  VoxelBox box = {shape.points.front(), shape.points.front()};
  for (const VoxelPos& p : shape.points) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  const std::int32_t r = shape.radius;
  return {{box.min.x - r, box.min.y - r, box.min.z - r},
          {box.max.x + r + 1, box.max.y + r + 1, box.max.z + r + 1}};
}
VoxelBox box_of_shape(const Paste& shape) { return box_of(shape); }
constexpr VoxelPos kNowhere{-kWorldLimit, -kWorldLimit, -kWorldLimit};
VoxelBox box_of_shape(const RightsEdit& shape) {
  return place_of(*shape.change).value_or(VoxelBox{kNowhere, kNowhere});
}
VoxelBox box_of_shape(const MaterialsEdit&) { return {kNowhere, kNowhere}; }
VoxelBox box_of_shape(const LibraryEdit&) { return {kNowhere, kNowhere}; }
VoxelBox box_of_shape(const ShapesEdit&) { return {kNowhere, kNowhere}; }
VoxelBox box_of_shape(const TextureEdit&) { return {kNowhere, kNowhere}; }
VoxelBox box_of_shape(const ClockEdit&) { return {kNowhere, kNowhere}; }
VoxelBox box_of_shape(const GapEdit&) { return {kNowhere, kNowhere}; }

// Returns an upper bound for the voxels of the segment's capsule. Across the longest axis of the
// segment, each of its n + w layers (w = 2r + 1) is a part of an ellipse of area at most sqrt(3) pi
// (r^2 + r) and outline at most 2 sqrt(2) pi sqrt(r^2 + r). A convex figure holds at most area +
// outline / 2 + 1 points of the grid (Nosarzewska 1948). Here this is fewer than 1.361 w^2 + 2.222
// w + 1 <= 2 w^2 for w >= 5, and 18 = 2 w^2 for w = 3.
std::uint64_t counted_segment(const FillStroke& stroke, std::size_t i) {
  const VoxelPos &a = stroke.points[i], &b = stroke.points[i + 1];
  const auto width = 2 * std::uint64_t{stroke.radius} + 1;
  const auto reach = std::max({std::abs(b.x - a.x), std::abs(b.y - a.y), std::abs(b.z - a.z)});
  return std::min(volume_of(segment_box(stroke, i)),
                  2 * width * width * (static_cast<std::uint64_t>(reach) + width));
}

// The axis of the segment's longest side runs fastest: this gives the fewest lines.
AxisOrder order_along(const FillStroke& stroke, std::size_t i) {
  const VoxelPos &a = stroke.points[i], &b = stroke.points[i + 1];
  const auto x = std::abs(b.x - a.x), y = std::abs(b.y - a.y), z = std::abs(b.z - a.z);
  return x >= y && x >= z ? AxisOrder::xyz : y >= z ? AxisOrder::yxz : AxisOrder::zxy;
}

bool touches_segment(const FillStroke& stroke, std::size_t i, const VoxelBox& box) {
  // Coordinates are relative to the near part of the box, so that they stay small.
  const VoxelBox near = intersect(segment_box(stroke, i), box);
  if (near.empty()) return false;
  const auto capsule = clip_segment(stroke, i, near, order_along(stroke, i));
  return capsule && has_voxel(*capsule);
}

// Returns the voxels of a sphere: the rows of one quarter of its (x, y) disc, times the number of
// their mirror images.
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

ChunkRange chunk_range(const VoxelBox& box, std::int32_t edge) {
  RUNSTONE_ASSERT(edge == 16 || edge == 32 || edge == 64 || edge == 128);
  return {chunk_of(box.min, edge), chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge)};
}

std::uint64_t chunks_of(const ChunkRange& range) {
  return static_cast<std::uint64_t>(range.last.x - range.first.x + 1) *
         static_cast<std::uint64_t>(range.last.y - range.first.y + 1) *
         static_cast<std::uint64_t>(range.last.z - range.first.z + 1);
}

// Appends the chunks of the range for which passes() returns true, in ascending order.
template <class F>
void append_chunks(const ChunkRange& range, std::vector<ChunkCoord>& out, F&& passes) {
  const auto& [first, last] = range;
  for (ChunkCoord c{first.x, 0, 0}; c.x <= last.x; ++c.x) {
    for (c.y = first.y; c.y <= last.y; ++c.y) {
      for (c.z = first.z; c.z <= last.z; ++c.z) {
        if (passes(c)) out.push_back(c);
      }
    }
  }
}

std::size_t segment_count(const FillStroke& stroke) { return stroke.points.size() - 1; }

}  // namespace

VoxelBox bounding_box(const EditDescriptor& edit) {
  return std::visit([](const auto& shape) { return box_of_shape(shape); }, edit.shape);
}

VoxelBox segment_box(const FillStroke& stroke, std::size_t i) {
  const VoxelPos &a = stroke.points[i], &b = stroke.points[i + 1];
  const std::int32_t r = stroke.radius;
  return {{std::min(a.x, b.x) - r, std::min(a.y, b.y) - r, std::min(a.z, b.z) - r},
          {std::max(a.x, b.x) + r + 1, std::max(a.y, b.y) + r + 1, std::max(a.z, b.z) + r + 1}};
}

std::uint64_t counted_voxels(const EditDescriptor& edit) {
  if (const auto* sphere = std::get_if<FillSphere>(&edit.shape))
    return sphere_voxels(sphere->radius);
  if (const auto* stroke = std::get_if<FillStroke>(&edit.shape)) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < segment_count(*stroke); ++i) count += counted_segment(*stroke, i);
    return count;
  }
  if (const auto* paste = std::get_if<Paste>(&edit.shape)) return paste->clipboard->touched();
  if (!has_voxels(edit)) return 0;
  return volume_of(bounding_box(edit));
}

bool touches(const EditDescriptor& edit, const VoxelBox& box) {
  if (box.empty() || !has_voxels(edit)) return false;
  if (const auto* stroke = std::get_if<FillStroke>(&edit.shape)) {
    for (std::size_t i = 0; i < segment_count(*stroke); ++i) {
      if (touches_segment(*stroke, i, box)) return true;
    }
    return false;
  }
  if (const auto* paste = std::get_if<Paste>(&edit.shape)) return touches(*paste, box);
  const auto* sphere = std::get_if<FillSphere>(&edit.shape);
  if (sphere == nullptr) return !intersect(bounding_box(edit), box).empty();
  // The voxel of the box nearest to the centre decides. Distances are taken between voxel
  // positions.
  const std::int64_t r = sphere->radius;
  const std::array<std::array<std::int64_t, 3>, 3> axes = {
      {{sphere->centre.x, box.min.x, box.max.x},
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
  std::vector<ChunkCoord> out;
  touched_chunks(edit, edge, out);
  return out;
}

void touched_chunks(const EditDescriptor& edit, std::int32_t edge, std::vector<ChunkCoord>& out) {
  out.clear();
  if (const auto* voxel = std::get_if<SetVoxel>(&edit.shape)) {  // by far the most frequent kind
    out.push_back(chunk_of(voxel->at, edge));
    return;
  }
  if (const auto* stroke = std::get_if<FillStroke>(&edit.shape)) {
    for (std::size_t i = 0; i < segment_count(*stroke); ++i) {
      append_chunks(chunk_range(segment_box(*stroke, i), edge), out,
                    [&](ChunkCoord c) { return touches_segment(*stroke, i, box_of(c, edge)); });
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return;
  }
  if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
    out = touched_chunks(*paste, edge);
    return;
  }
  if (!has_voxels(edit)) return;
  append_chunks(chunk_range(bounding_box(edit), edge), out,
                [&](ChunkCoord c) { return touches(edit, box_of(c, edge)); });
}

std::uint64_t touched_chunks_bound(const EditDescriptor& edit, std::int32_t edge) {
  if (std::holds_alternative<SetVoxel>(edit.shape)) return 1;
  if (const auto* stroke = std::get_if<FillStroke>(&edit.shape)) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < segment_count(*stroke); ++i) {
      count += chunks_of(chunk_range(segment_box(*stroke, i), edge));
    }
    // Several segments may touch one chunk.
    return std::min(count, chunks_of(chunk_range(bounding_box(edit), edge)));
  }
  if (!has_voxels(edit)) return 0;
  return chunks_of(chunk_range(bounding_box(edit), edge));
}

void append_spans(const EditDescriptor& edit, VoxelPos origin, Extent extent, AxisOrder order,
                  std::vector<IndexSpan>& out) {
  const std::size_t start = out.size();
  std::size_t parts = 0;
  for_each_part(edit, origin, extent, order, [&](const OrderedShape& shape, Material) {
    append_spans(shape, ordered(extent, order), out);
    ++parts;
  });
  if (parts > 1) unite_spans(out, start);
}

}  // namespace runstone
