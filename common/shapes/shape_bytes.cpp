#include "common/shapes/shape_bytes.hpp"

#include "common/core/assert.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone {

void write_shape(ByteWriter& out, const Shape& shape) {
  RUNSTONE_ASSERT(!shape.is_cube() && shape.boxes.size() <= kShapeBoxesMax);
  out.u8(static_cast<std::uint8_t>(shape.form));
  out.u8(static_cast<std::uint8_t>(shape.boxes.size()));
  for (const ShapeBox& box : shape.boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.u8(static_cast<std::uint8_t>(box.min[axis] | (box.max[axis] - 1) << 4));
  }
}

Shape read_shape(ByteReader& in) {
  Shape out;
  const std::uint8_t form = in.u8(), count = in.u8();
  if (!in.ok()) return {};
  if (form > static_cast<std::uint8_t>(ShapeForm::crossed) || count == 0 ||
      count > kShapeBoxesMax) {
    in.reject(ErrorCode::bad_value, "form of a shape is unknown, or it has not 1 .. 32 boxes");
    return {};
  }
  out.form = static_cast<ShapeForm>(form);
  for (std::uint8_t i = 0; i < count; ++i) {
    ShapeBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint8_t byte = in.u8();
      box.min[axis] = byte & 15;
      box.max[axis] = static_cast<std::uint8_t>((byte >> 4) + 1);
    }
    out.boxes.push_back(box);
  }
  if (!in.ok()) return {};
  if (const auto valid = check_shape(out); !valid) {
    in.reject(valid.error().code, valid.error().what);
    return {};
  }
  return out;
}

}  // namespace runstone
