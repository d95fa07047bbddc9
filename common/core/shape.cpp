#include "common/core/shape.hpp"

namespace runstone {

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
