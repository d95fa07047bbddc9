#include "common/shapes/turned_shape.hpp"

namespace runstone {

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

}  // namespace runstone
