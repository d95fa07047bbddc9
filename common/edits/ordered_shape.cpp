#include "common/edits/ordered_shape.hpp"

namespace runstone {

std::optional<OrderedShape> clip(const EditDescriptor& edit, VoxelPos origin, Extent extent,
                                 AxisOrder order) {
  const VoxelBox chunk = {origin, {origin.x + extent.x, origin.y + extent.y, origin.z + extent.z}};
  const VoxelBox box = intersect(bounding_box(edit), chunk);
  if (box.empty()) return std::nullopt;
  const std::array<std::int32_t, 3> low = {box.min.x - origin.x, box.min.y - origin.y, box.min.z - origin.z};
  const std::array<std::int32_t, 3> high = {box.max.x - origin.x, box.max.y - origin.y, box.max.z - origin.z};
  std::array<std::int32_t, 3> centre{};
  OrderedShape out;
  if (const auto* sphere = std::get_if<FillSphere>(&edit.shape)) {
    centre = {sphere->centre.x - origin.x, sphere->centre.y - origin.y, sphere->centre.z - origin.z};
    out.round = true;
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
