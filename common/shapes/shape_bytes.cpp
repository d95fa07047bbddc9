#include "common/shapes/shape_bytes.hpp"

#include <algorithm>

namespace runstone {

void write_shape(ByteWriter& w, const Shape& shape) {
  w.u8(static_cast<std::uint8_t>(shape.form));
  w.varint(shape.boxes.size());
  for (const ShapeBox& box : shape.boxes) {
    w.bytes(box.min);
    w.bytes(box.max);
  }
}

Shape read_shape(ByteReader& r) {
  Shape shape;
  shape.form = static_cast<ShapeForm>(r.u8());
  const std::uint64_t count = r.varint_max(kShapeBoxesMax, "a shape has more than 32 boxes");
  while (r.ok() && shape.boxes.size() < count) {
    ShapeBox box;
    for (auto* corner : {&box.min, &box.max}) {
      const ByteView bytes = r.bytes(corner->size());
      std::copy(bytes.begin(), bytes.end(), corner->begin());
    }
    if (r.ok()) shape.boxes.push_back(box);
  }
  return shape;
}

}  // namespace runstone
