#include "common/shapes/turned_shape.hpp"

#include <algorithm>
#include <vector>

namespace runstone {
namespace {

/// Returns the cells that boxes fill: bit x of row y + 16 z.
std::array<std::uint16_t, 256> filled_rows(const Shape& shape) {
  std::array<std::uint16_t, 256> out{};
  for (const auto& [min, max] : shape.boxes) {
    const unsigned bits = (1U << max[0]) - (1U << min[0]);
    for (std::size_t z = min[2]; z < max[2]; ++z) {
      for (std::size_t y = min[1]; y < max[1]; ++y)
        out[y + 16 * z] = static_cast<std::uint16_t>(out[y + 16 * z] | bits);
    }
  }
  return out;
}

std::vector<ShapeBox> sorted_boxes(const Shape& shape) {
  std::vector<ShapeBox> out = shape.boxes;
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

Shape turned(const Shape& shape, std::array<Axis, 3> along, std::uint8_t flips) {
  Shape out = shape;
  if (shape.form == ShapeForm::crossed && along[1] != Axis::y) return out;
  for (std::size_t i = 0; i < shape.boxes.size(); ++i) {
    for (std::size_t world = 0; world < 3; ++world) {
      const auto axis = static_cast<std::size_t>(along[world]);
      const std::uint8_t min = shape.boxes[i].min[axis], max = shape.boxes[i].max[axis];
      const bool is_flipped = (flips >> world & 1) != 0;
      out.boxes[i].min[world] = is_flipped ? static_cast<std::uint8_t>(kShapeUnits - max) : min;
      out.boxes[i].max[world] = is_flipped ? static_cast<std::uint8_t>(kShapeUnits - min) : max;
    }
  }
  return out;
}

Shape turned_about_y(const Shape& shape, unsigned quarters) {
  switch (quarters % 4) {
    case 1:
      return turned(shape, {Axis::z, Axis::y, Axis::x}, 1);
    case 2:
      return turned(shape, {Axis::x, Axis::y, Axis::z}, 1 | 4);
    case 3:
      return turned(shape, {Axis::z, Axis::y, Axis::x}, 4);
    default:
      return shape;
  }
}

bool look_alike(const Shape& a, const Shape& b) {
  if (a.form != b.form || a.is_cube() != b.is_cube()) return false;
  if (a.form == ShapeForm::crossed) return sorted_boxes(a) == sorted_boxes(b);
  return filled_rows(a) == filled_rows(b);
}

}  // namespace runstone
