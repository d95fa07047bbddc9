#include "protocol/codec/shape_list.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/shapes/shape_bytes.hpp"

namespace runstone {

ShapeList::ShapeList(const MaterialTable& table) {
  for (const MaterialInfo& row : table.rows()) {
    if (!row.shape.is_cube()) shapes_.push_back(&row.shape);
  }
  std::sort(shapes_.begin(), shapes_.end(), ShapeBefore{});
  const auto same = [](const Shape* a, const Shape* b) { return *a == *b; };
  shapes_.erase(std::unique(shapes_.begin(), shapes_.end(), same), shapes_.end());
}

std::uint16_t ShapeList::number_of(const Shape& shape) const {
  const auto at = std::lower_bound(shapes_.begin(), shapes_.end(), &shape, ShapeBefore{});
  RUNSTONE_ASSERT(at != shapes_.end() && **at == shape);
  return static_cast<std::uint16_t>(at - shapes_.begin() + 1);
}

Bytes ShapeList::encode() const {
  RUNSTONE_ASSERT(shapes_.size() <= kTableShapesMax);
  Bytes bytes;
  ByteWriter w(bytes);
  for (const Shape* shape : shapes_) write_shape(w, *shape);
  return bytes;
}

Result<std::vector<Shape>> decode_shapes(ByteView bytes) {
  std::vector<Shape> shapes;
  ByteReader r(bytes);
  while (r.ok() && !r.at_end()) {
    if (shapes.size() == kTableShapesMax)
      return fail(ErrorCode::limit_exceeded, "more than 4096 different shapes");
    Shape shape = read_shape(r);
    if (!r.ok()) break;
    if (!shapes.empty() && shapes.back() >= shape)
      return fail(ErrorCode::not_canonical, "shapes of the list do not ascend", r.offset());
    shapes.push_back(std::move(shape));
  }
  if (const auto done = r.finish(); !done) return failure(done.error());
  return shapes;
}

}  // namespace runstone
