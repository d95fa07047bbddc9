#include "common/edits/descriptor/given_shapes.hpp"

#include <algorithm>
#include <set>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

using ShapeSet = std::set<const Shape*, ShapeBefore>;

/// Counts the rows of a record as they are added.
class GivenCount {
 public:
  /// Returns false if a record has no room for the row as well. The shape must outlive the object.
  bool add(const GivenShape& row) {
    if (rows_ == kGivenShapesMax) return false;
    if (!shapes_.contains(&row.shape)) {
      if (shapes_.size() == kDifferentShapesMax) return false;
      shapes_.insert(&row.shape);
    }
    ++rows_;
    return true;
  }

 private:
  ShapeSet shapes_;
  std::size_t rows_ = 0;
};

}  // namespace

Result<void> validate(const GivenShapes& given) {
  if (given.rows.empty()) return fail(ErrorCode::bad_value, "no shapes are given");
  GivenCount count;
  std::size_t before = kEmpty;
  for (const GivenShape& row : given.rows) {
    if (row.material <= before)
      return fail(ErrorCode::bad_value, "materials of given shapes do not ascend from 1");
    before = row.material;
    if (row.shape.is_cube()) return fail(ErrorCode::bad_value, "a given shape is a cube");
    if (auto sound = validate_shape(row.shape); !sound) return sound;
    if (!count.add(row))
      return fail(ErrorCode::limit_exceeded, "too many shapes are given", kGivenShapesMax);
  }
  return {};
}

GivenShapes first_of(std::span<const GivenShape> rows) {
  GivenCount count;
  GivenShapes first;
  for (const GivenShape& row : rows) {
    if (!count.add(row)) break;
    first.rows.push_back(row);
  }
  RUNSTONE_ASSERT(!first.rows.empty());
  return first;
}

void write_given_shapes(ByteWriter& w, const GivenShapes& given) {
  ShapeSet set;
  for (const GivenShape& row : given.rows) set.insert(&row.shape);
  const std::vector<const Shape*> shapes(set.begin(), set.end());
  w.varint(shapes.size() - 1);
  for (const Shape* shape : shapes) write_shape(w, *shape);
  w.varint(given.rows.size() - 1);
  Material before = kEmpty;
  for (const GivenShape& row : given.rows) {
    w.varint(static_cast<std::uint64_t>(row.material - before - 1));
    before = row.material;
    const auto at = std::lower_bound(shapes.begin(), shapes.end(), &row.shape, ShapeBefore{});
    w.varint(static_cast<std::uint64_t>(at - shapes.begin()));
  }
}

GivenShapes read_given_shapes(ByteReader& r) {
  GivenShapes given;
  const std::uint64_t shape_count =
      1 + r.varint_max(kDifferentShapesMax - 1, "too many different shapes are given");
  std::vector<Shape> shapes;
  while (r.ok() && shapes.size() < shape_count) {
    shapes.push_back(read_shape(r));
    if (r.ok() && shapes.size() > 1 && shapes[shapes.size() - 2] >= shapes.back())
      r.reject(ErrorCode::not_canonical, "given shapes do not ascend");
  }
  const std::uint64_t count = 1 + r.varint_max(kGivenShapesMax - 1, "too many shapes are given");
  std::uint64_t material = kEmpty;
  std::vector<bool> used(shapes.size(), false);
  while (r.ok() && given.rows.size() < count) {
    material += 1 + r.varint_max(kMaterialCountMax - 1, "material id exceeds 16 bits");
    if (material >= kMaterialCountMax)
      r.reject(ErrorCode::bad_value, "material id exceeds 16 bits");
    const std::uint64_t shape = r.varint_max(shape_count - 1, "number of a given shape is unknown");
    if (!r.ok()) break;
    used[static_cast<std::size_t>(shape)] = true;
    given.rows.push_back(
        {static_cast<Material>(material), shapes[static_cast<std::size_t>(shape)]});
  }
  if (r.ok() && std::find(used.begin(), used.end(), false) != used.end())
    r.reject(ErrorCode::not_canonical, "a given shape has no material");
  return given;
}

}  // namespace runstone
