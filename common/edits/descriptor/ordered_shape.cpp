#include "common/edits/descriptor/ordered_shape.hpp"

#include <cstdlib>

namespace runstone {
namespace {

using Axes3 = std::array<std::int32_t, 3>;

// Returns true if some point of the segment may be within r + 1/2 of a voxel of the box low .. high
// (both included). The part of the segment that is near the box along the segment's longest axis
// must be near it along the other axes too.
bool may_meet(const Axes3& start, const Axes3& along, std::int32_t r, const Axes3& low,
              const Axes3& high) {
  std::size_t k = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(along[i]) > std::abs(along[k])) k = i;
  }
  const std::int64_t length = std::abs(along[k]);
  const std::int64_t sign = along[k] < 0 ? -1 : 1;
  // Distances along the axis, 0 .. length.
  const std::int64_t to_low = sign * (std::int64_t{low[k]} - start[k]);
  const std::int64_t to_high = sign * (std::int64_t{high[k]} - start[k]);
  const std::int64_t from = std::max<std::int64_t>(0, std::min(to_low, to_high) - r - 1);
  const std::int64_t to = std::min(length, std::max(to_low, to_high) + r + 1);
  if (from > to) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i == k) continue;
    const std::int64_t a = along[i] * from, b = along[i] * to;
    const std::int64_t least = start[i] + detail::floor_of(std::min(a, b), length);
    const std::int64_t most = start[i] + detail::ceil_of(std::max(a, b), length);
    if (least - r > high[i] || most + r < low[i]) return false;
  }
  return true;
}

}  // namespace

std::optional<OrderedShape> clip(const EditDescriptor& edit, VoxelPos origin, Extent extent,
                                 AxisOrder order) {
  if (const auto* one = std::get_if<SetVoxel>(&edit.shape))
    return clip_voxel(one->at, origin, extent, order);
  const VoxelBox chunk = {origin, {origin.x + extent.x, origin.y + extent.y, origin.z + extent.z}};
  const VoxelBox box = intersect(bounding_box(edit), chunk);
  if (box.empty()) return std::nullopt;
  const std::array<std::int32_t, 3> low = {box.min.x - origin.x, box.min.y - origin.y,
                                           box.min.z - origin.z};
  const std::array<std::int32_t, 3> high = {box.max.x - origin.x, box.max.y - origin.y,
                                            box.max.z - origin.z};
  std::array<std::int32_t, 3> centre{};
  OrderedShape out;
  if (const auto* sphere = std::get_if<FillSphere>(&edit.shape)) {
    centre = {sphere->centre.x - origin.x, sphere->centre.y - origin.y,
              sphere->centre.z - origin.z};
    out.form = OrderedShape::Form::sphere;
    out.reach = sphere->radius * (sphere->radius + 1);
  }
  const auto axes = axes_of(order);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(axes[i]);
    out.first[i] = static_cast<std::uint32_t>(low[axis]);
    out.last[i] = static_cast<std::uint32_t>(high[axis]);
    out.centre[i] = centre[axis];
  }
  return out;
}

std::optional<OrderedShape> clip_segment(const FillStroke& stroke, std::size_t i,
                                         const VoxelBox& box, AxisOrder order) {
  const VoxelBox inside = intersect(segment_box(stroke, i), box);
  if (inside.empty()) return std::nullopt;
  const VoxelPos &a = stroke.points[i], &b = stroke.points[i + 1], &origin = box.min;
  const Axes3 low = {inside.min.x - origin.x, inside.min.y - origin.y, inside.min.z - origin.z};
  const Axes3 high = {inside.max.x - origin.x - 1, inside.max.y - origin.y - 1,
                      inside.max.z - origin.z - 1};
  const Axes3 start = {a.x - origin.x, a.y - origin.y, a.z - origin.z};
  const Axes3 along = {b.x - a.x, b.y - a.y, b.z - a.z};
  if (!may_meet(start, along, stroke.radius, low, high)) return std::nullopt;
  OrderedShape out;
  out.form = OrderedShape::Form::capsule;
  out.reach = stroke.radius * (stroke.radius + 1);
  const auto axes = axes_of(order);
  for (std::size_t j = 0; j < 3; ++j) {
    const auto axis = static_cast<std::size_t>(axes[j]);
    out.first[j] = static_cast<std::uint32_t>(low[axis]);
    out.last[j] = static_cast<std::uint32_t>(high[axis] + 1);
    out.centre[j] = start[axis];
    out.along[j] = along[axis];
  }
  return out;
}

bool has_voxel(const OrderedShape& capsule) {
  for (std::uint32_t s = capsule.first[2]; s < capsule.last[2]; ++s) {
    const auto none = [](std::uint32_t, std::uint32_t, std::uint32_t) { return false; };
    if (!visit_capsule_rows(capsule, s, none)) return true;
  }
  return false;
}

void unite_spans(std::vector<IndexSpan>& spans, std::size_t start) {
  const auto begin = spans.begin() + static_cast<std::ptrdiff_t>(start);
  std::sort(begin, spans.end(),
            [](const IndexSpan& a, const IndexSpan& b) { return a.first < b.first; });
  std::size_t kept = start;
  for (std::size_t i = start; i < spans.size(); ++i) {
    if (kept > start && spans[i].first <= spans[kept - 1].last) {
      spans[kept - 1].last = std::max(spans[kept - 1].last, spans[i].last);
    } else {
      spans[kept++] = spans[i];
    }
  }
  spans.resize(kept);
}

void append_spans(const OrderedShape& shape, OrderedExtent e, std::vector<IndexSpan>& out) {
  if (shape.covers_layers(e)) {
    out.push_back({shape.first[2] * e.layer(), shape.last[2] * e.layer()});
    return;
  }
  const std::size_t start = out.size();
  for (std::uint32_t s = shape.first[2]; s < shape.last[2]; ++s) {
    const VoxelIndex layer = s * e.layer();
    if (shape.covers_lines(e)) {
      out.push_back({layer + shape.first[1] * e.f, layer + shape.last[1] * e.f});
      continue;
    }
    for_each_row(shape, s, [&](std::uint32_t m, std::uint32_t first, std::uint32_t last) {
      const VoxelIndex line = layer + m * e.f;
      if (out.size() > start && out.back().last == line + first) {
        out.back().last = line + last;
      } else {
        out.push_back({line + first, line + last});
      }
    });
  }
}

}  // namespace runstone
