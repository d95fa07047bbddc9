#include "common/core/shape.hpp"

#include <algorithm>

namespace runstone {

// The standard library of the client for browsers does not compare arrays or vectors in three ways.
std::strong_ordering operator<=>(const ShapeBox& a, const ShapeBox& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.min[axis] != b.min[axis]) return a.min[axis] <=> b.min[axis];
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.max[axis] != b.max[axis]) return a.max[axis] <=> b.max[axis];
  }
  return std::strong_ordering::equal;
}

std::strong_ordering operator<=>(const Shape& a, const Shape& b) {
  if (a.form != b.form) return a.form <=> b.form;
  const std::size_t both = std::min(a.boxes.size(), b.boxes.size());
  for (std::size_t i = 0; i < both; ++i) {
    const std::strong_ordering order = a.boxes[i] <=> b.boxes[i];
    if (order != std::strong_ordering::equal) return order;
  }
  return a.boxes.size() <=> b.boxes.size();
}

Result<void> validate_shape(const Shape& shape) {
  if (shape.form > ShapeForm::crossed) return fail(ErrorCode::bad_value, "unknown form of a shape");
  if (shape.is_cube() && shape.form != ShapeForm::boxes)
    return fail(ErrorCode::bad_value, "a shape of crossed planes needs a box");
  if (shape.boxes.size() > kShapeBoxesMax)
    return fail(ErrorCode::limit_exceeded, "a shape has more than 32 boxes", kShapeBoxesMax);
  for (std::size_t i = 0; i < shape.boxes.size(); ++i) {
    const ShapeBox& box = shape.boxes[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box.min[axis] >= box.max[axis] || box.max[axis] > kShapeUnits) {
        return fail(ErrorCode::bad_value, "a box of a shape is empty or leaves the voxel", i);
      }
    }
  }
  return {};
}

}  // namespace runstone
