// The canonical bytes of a shape: its form, the number of its boxes, and six bytes a box, which are
// min and max along x, y and z. Records of the log and messages hold them.
#pragma once
#include "common/core/bytes.hpp"
#include "common/core/shape.hpp"

namespace runstone {

/// Appends the bytes of a shape. Requires validate_shape().
void write_shape(ByteWriter& w, const Shape& shape);
/// Reads what write_shape() wrote. A failure is found in the reader. The result is not validated.
/// Memory: O(bytes).
Shape read_shape(ByteReader& r);

}  // namespace runstone
