// OrderedShape: the geometry of an edit in the order of one chunk (fastest, middle, slowest axis),
// clipped to the chunk. Boxes, spheres and the segments of a stroke are convex, so each line of the
// chunk meets them in at most one row of voxels. All users of the geometry work on these rows. It
// uses integers only. Internal to edits.
//   - A stroke has one shape per segment. Applying a mask and a material twice to a voxel equals
//     applying them once: the second application keeps or repeats what the first one wrote.
//   - A paste has one box per box of its runs in the chunk. These boxes do not overlap.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/edits/descriptor/capsule_row.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/placed_clipboard.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/span_boxes.hpp"

namespace runstone {

/// Returns the largest w with w * w <= v.
constexpr std::uint32_t isqrt(std::uint32_t v) {
  std::uint32_t root = 0;
  if (v == 0) return 0;
  for (int shift = (std::bit_width(v) - 1) / 2; shift >= 0; --shift) {
    const std::uint32_t trial = root | 1u << shift;
    if (static_cast<std::uint64_t>(trial) * trial <= v) root = trial;
  }
  return root;
}

struct OrderedShape {
  enum class Form : std::uint8_t { box, sphere, capsule };
  // Clipped bounding box along f, m, s. Half-open, never empty.
  std::array<std::uint32_t, 3> first{}, last{};
  // Centre of a sphere or start of a capsule, relative to the first voxel.
  std::array<std::int32_t, 3> centre{};
  std::array<std::int32_t, 3> along{};  // from a capsule's start to its end
  std::int32_t reach = 0;               // r * r + r: the largest squared distance inside
  Form form = Form::box;

  bool covers_layers(OrderedExtent e) const {
    return covers_lines(e) && first[1] == 0 && last[1] == e.m;
  }
  bool covers_lines(OrderedExtent e) const {
    return form == Form::box && first[0] == 0 && last[0] == e.f;
  }
};

/// Returns nullopt if the bounding box misses the chunk. A sphere may still have no voxel inside.
/// Requires no stroke and no paste: their parts are clipped one by one. Cost: O(1).
std::optional<OrderedShape> clip(const EditDescriptor& edit, VoxelPos origin, Extent extent,
                                 AxisOrder order);

/// Returns nullopt if the voxel lies outside the chunk. Most edits are single voxels, so this form
/// of clip() has no boxes and is inline.
inline std::optional<OrderedShape> clip_voxel(VoxelPos at, VoxelPos origin, Extent extent,
                                              AxisOrder order) {
  const auto x = static_cast<std::uint32_t>(at.x - origin.x);
  const auto y = static_cast<std::uint32_t>(at.y - origin.y);
  const auto z = static_cast<std::uint32_t>(at.z - origin.z);
  if (x >= extent.x || y >= extent.y || z >= extent.z) return std::nullopt;
  const auto along = [&](Axis axis) { return axis == Axis::x ? x : axis == Axis::y ? y : z; };
  const auto axes = axes_of(order);
  const std::array<std::uint32_t, 3> place = {along(axes[0]), along(axes[1]), along(axes[2])};
  return OrderedShape{
      place, {place[0] + 1, place[1] + 1, place[2] + 1}, {}, {}, 0, OrderedShape::Form::box};
}

/// Returns the segment from point `i` of the stroke to the next one, clipped to a box of voxels,
/// relative to the box's first voxel. Returns nullopt if the segment misses the box. For a few
/// segments that miss it closely, the result has no rows instead. Cost: O(1).
std::optional<OrderedShape> clip_segment(const FillStroke& stroke, std::size_t i,
                                         const VoxelBox& box, AxisOrder order);

/// Returns true if the capsule has a voxel inside its clipped box. The answer is exact. Cost:
/// O(lines it meets until one is found).
bool has_voxel(const OrderedShape& capsule);

/// Calls part(box, material) for the boxes of the paste's runs in the chunk, in index order.
/// Allocates. Cost: O(runs inside + lines inside * log runs).
template <class F>
void for_each_pasted_box(const Paste& paste, const VoxelBox& chunk, AxisOrder order, F&& part) {
  const auto placed = placed_cells(paste, chunk, order);
  if (!placed) return;
  const VoxelPos& low = placed->box.min;
  const auto axes = axes_of(order);
  const std::array<std::int32_t, 3> offset = {low.x - chunk.min.x, low.y - chunk.min.y,
                                              low.z - chunk.min.z};
  placed->cells.runs.visit([&](const auto& runs) {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); begin = runs.end(i++)) {
      if (runs.material(i) == 0) continue;
      const Material material = paste.clipboard->material(runs.material(i));
      for_each_box(ordered(placed->cells.extent, order), begin, runs.end(i),
                   [&](const OrderedBox& box) {
                     OrderedShape shape;
                     for (std::size_t rank = 0; rank < 3; ++rank) {
                       const auto by =
                           static_cast<std::uint32_t>(offset[static_cast<std::size_t>(axes[rank])]);
                       shape.first[rank] = box.first[rank] + by;
                       shape.last[rank] = box.last[rank] + by;
                     }
                     part(shape, material);
                   });
    }
  });
}

/// Calls part(shape, material) for each shape of the edit that may have a voxel in the chunk: one
/// shape, or one per segment of a stroke or box of a paste.
template <class F>
void for_each_part(const EditDescriptor& edit, VoxelPos origin, Extent extent, AxisOrder order,
                   F&& part) {
  if (const auto* one = std::get_if<SetVoxel>(&edit.shape)) {
    if (const auto shape = clip_voxel(one->at, origin, extent, order)) part(*shape, edit.material);
    return;
  }
  const VoxelBox chunk = {origin, {origin.x + extent.x, origin.y + extent.y, origin.z + extent.z}};
  if (const auto* stroke = std::get_if<FillStroke>(&edit.shape)) {
    for (std::size_t i = 0; i + 1 < stroke->points.size(); ++i) {
      if (const auto shape = clip_segment(*stroke, i, chunk, order)) part(*shape, edit.material);
    }
  } else if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
    for_each_pasted_box(*paste, chunk, order, part);
  } else if (!has_voxels(edit)) {
    return;
  } else if (const auto shape = clip(edit, origin, extent, order)) {
    part(*shape, edit.material);
  }
}

/// Appends spans as append_spans() of edit_geometry.hpp, for a shape that is clipped already.
void append_spans(const OrderedShape& shape, OrderedExtent e, std::vector<IndexSpan>& out);

/// Merges the spans from `start` on, which several shapes appended, into one ascending list of
/// disjoint stretches.
void unite_spans(std::vector<IndexSpan>& spans, std::size_t start);

/// Calls row(m, first, last) for a capsule as for_each_row() does, until it returns false. Cost:
/// O(lines it meets).
template <class F>
bool visit_capsule_rows(const OrderedShape& shape, std::uint32_t s, F&& row) {
  const std::int64_t qs = static_cast<std::int64_t>(s) - shape.centre[2];
  const std::int64_t df = shape.along[0], dm = shape.along[1], ds = shape.along[2];
  // The lines that the capsule meets are the row of its projection onto the plane across them.
  const CapsuleRow lines = capsule_row(dm, ds * ds, qs * ds, qs * qs, shape.reach);
  const std::int64_t m_first =
      std::max<std::int64_t>(shape.first[1], lines.first + shape.centre[1]);
  const std::int64_t m_last =
      std::min<std::int64_t>(shape.last[1], lines.last + shape.centre[1] + 1);
  for (std::int64_t m = m_first; m < m_last; ++m) {
    const std::int64_t qm = m - shape.centre[1];
    const CapsuleRow inside =
        capsule_row(df, dm * dm + ds * ds, qm * dm + qs * ds, qm * qm + qs * qs, shape.reach);
    const std::int64_t f_first =
        std::max<std::int64_t>(shape.first[0], inside.first + shape.centre[0]);
    const std::int64_t f_last =
        std::min<std::int64_t>(shape.last[0], inside.last + shape.centre[0] + 1);
    if (f_first >= f_last) continue;
    if (!row(static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(f_first),
             static_cast<std::uint32_t>(f_last))) {
      return false;
    }
  }
  return true;
}

/// Calls row(m, first, last) for the voxels [first, last) of each line that the shape meets in
/// layer `s`, ascending. Requires s inside the clipped box. Cost: O(lines), plus O(radius) once for
/// a sphere.
template <class F>
void for_each_row(const OrderedShape& shape, std::uint32_t s, F&& row) {
  if (shape.form == OrderedShape::Form::capsule) {
    visit_capsule_rows(shape, s, [&row](std::uint32_t m, std::uint32_t first, std::uint32_t last) {
      row(m, first, last);
      return true;
    });
    return;
  }
  if (shape.form == OrderedShape::Form::box) {
    for (std::uint32_t m = shape.first[1]; m < shape.last[1]; ++m)
      row(m, shape.first[0], shape.last[0]);
    return;
  }
  const std::int32_t ds = static_cast<std::int32_t>(s) - shape.centre[2];
  const std::int32_t in_layer = shape.reach - ds * ds;
  if (in_layer < 0) return;
  const auto m_reach = static_cast<std::int32_t>(isqrt(static_cast<std::uint32_t>(in_layer)));
  const auto m_first =
      std::max(static_cast<std::int32_t>(shape.first[1]), shape.centre[1] - m_reach);
  const auto m_last =
      std::min(static_cast<std::int32_t>(shape.last[1]), shape.centre[1] + m_reach + 1);
  if (m_first >= m_last) return;
  const auto left_over = [&](std::int32_t m) {
    return in_layer - (m - shape.centre[1]) * (m - shape.centre[1]);
  };
  // The half width follows the circle from line to line. In total it moves at most the radius up
  // and the radius down.
  auto half = static_cast<std::int32_t>(isqrt(static_cast<std::uint32_t>(left_over(m_first))));
  for (std::int32_t m = m_first; m < m_last; ++m) {
    const std::int32_t rest = left_over(m);
    while ((half + 1) * (half + 1) <= rest) ++half;
    while (half * half > rest) --half;
    const auto f_first =
        std::max(static_cast<std::int32_t>(shape.first[0]), shape.centre[0] - half);
    const auto f_last =
        std::min(static_cast<std::int32_t>(shape.last[0]), shape.centre[0] + half + 1);
    if (f_first < f_last) {
      row(static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(f_first),
          static_cast<std::uint32_t>(f_last));
    }
  }
}

}  // namespace runstone
