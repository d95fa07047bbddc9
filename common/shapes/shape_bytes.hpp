// The bytes of a shape, as logs and files of builds hold them (docs/edit-log.md):
//   form     u8  ShapeForm
//   boxes    u8  number of boxes, 1 .. kShapeBoxesMax
//   for each box, along x, y and z: u8, min in the low four bits, max - 1 in the high four
// Equal shapes have equal bytes, and different shapes have different bytes. Boxes keep their order.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"
#include "common/core/shape.hpp"

namespace runstone {

/// The longest encoding of a shape.
inline constexpr std::size_t kShapeBytesMax = 2 + 3 * kShapeBoxesMax;

/// Requires a valid shape that is no cube.
void write_shape(ByteWriter& out, const Shape& shape);

/// Reads a shape for which check_shape() succeeds. Rejects the input otherwise, and then returns a
/// cube. Cost: that of check_shape().
Shape read_shape(ByteReader& in);

}  // namespace runstone
