// The byte list Welcome.shapes: the different shapes of the materials of a table.
// docs/protocol.md specifies the bytes. Thread: any.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/core/shape.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// The different shapes of a table, ascending. It refers to the shapes of the table.
class ShapeList {
 public:
  /// Makes an empty list, in which every material is a cube.
  ShapeList() = default;
  /// Cost: O(materials), and O(log shapes) for each that is no cube.
  explicit ShapeList(const MaterialTable& table);

  bool empty() const { return shapes_.empty(); }
  /// Returns the number of a row's shape, from 1, or 0 for a cube and for every row if the list is
  /// empty. Requires that a list that is not empty has the shape. Cost: O(log shapes).
  template <class Row>
  std::uint16_t number(const Row& row) const {
    return shapes_.empty() || row.shape.is_cube() ? std::uint16_t{0} : number_of(row.shape);
  }
  /// Returns the bytes. Requires at most kTableShapesMax shapes.
  Bytes encode() const;

 private:
  std::uint16_t number_of(const Shape& shape) const;
  std::vector<const Shape*> shapes_;
};

/// Returns the shapes of a list, of which number n is entry n - 1. Fails for more than
/// kTableShapesMax shapes, for shapes that are not valid, and for those that do not ascend.
/// Memory: O(bytes).
Result<std::vector<Shape>> decode_shapes(ByteView bytes);

}  // namespace runstone
