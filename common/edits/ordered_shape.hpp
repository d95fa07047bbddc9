// OrderedShape: an edit's geometry seen from one chunk, in the chunk's own order (fastest, middle, slowest
// axis) and clipped to it. Boxes and spheres are convex, so each line of the chunk meets them in at most one
// row of voxels; whoever needs the geometry asks for these rows. Internal to edits. Integers only.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/edits/edit_geometry.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Largest w with w * w <= v.
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
  std::array<std::uint32_t, 3> first{}, last{};  // clipped bounding box along f, m, s; half-open, never empty
  std::array<std::int32_t, 3> centre{};          // of a sphere, relative to the chunk's first voxel
  std::int32_t reach = 0;                        // r * r + r of a sphere: the largest squared distance inside
  bool round = false;

  bool covers_layers(OrderedExtent e) const {
    return !round && first[0] == 0 && last[0] == e.f && first[1] == 0 && last[1] == e.m;
  }
  bool covers_lines(OrderedExtent e) const { return !round && first[0] == 0 && last[0] == e.f; }
};

/// Nothing when the bounding box misses the chunk. O(1). A sphere may still have no voxel inside.
std::optional<OrderedShape> clip(const EditDescriptor& edit, VoxelPos origin, Extent extent, AxisOrder order);

/// append_spans() of edit_geometry.hpp for a shape that is clipped already.
void append_spans(const OrderedShape& shape, OrderedExtent e, std::vector<IndexSpan>& out);

/// Calls row(m, first, last) for the voxels [first, last) of each line that the shape meets in layer `s`,
/// ascending. Requires s inside the clipped box. O(lines), plus O(radius) once for a sphere.
template <class F>
void for_each_row(const OrderedShape& shape, std::uint32_t s, F&& row) {
  if (!shape.round) {
    for (std::uint32_t m = shape.first[1]; m < shape.last[1]; ++m) row(m, shape.first[0], shape.last[0]);
    return;
  }
  const std::int32_t ds = static_cast<std::int32_t>(s) - shape.centre[2];
  const std::int32_t in_layer = shape.reach - ds * ds;
  if (in_layer < 0) return;
  const auto m_reach = static_cast<std::int32_t>(isqrt(static_cast<std::uint32_t>(in_layer)));
  const auto m_first = std::max(static_cast<std::int32_t>(shape.first[1]), shape.centre[1] - m_reach);
  const auto m_last = std::min(static_cast<std::int32_t>(shape.last[1]), shape.centre[1] + m_reach + 1);
  if (m_first >= m_last) return;
  const auto left_over = [&](std::int32_t m) {
    return in_layer - (m - shape.centre[1]) * (m - shape.centre[1]);
  };
  // The half width follows the circle from line to line: it never steps more than the radius up and down.
  auto half = static_cast<std::int32_t>(isqrt(static_cast<std::uint32_t>(left_over(m_first))));
  for (std::int32_t m = m_first; m < m_last; ++m) {
    const std::int32_t rest = left_over(m);
    while ((half + 1) * (half + 1) <= rest) ++half;
    while (half * half > rest) --half;
    const auto f_first = std::max(static_cast<std::int32_t>(shape.first[0]), shape.centre[0] - half);
    const auto f_last = std::min(static_cast<std::int32_t>(shape.last[0]), shape.centre[0] + half + 1);
    if (f_first < f_last) {
      row(static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(f_first),
          static_cast<std::uint32_t>(f_last));
    }
  }
}

}  // namespace runstone
