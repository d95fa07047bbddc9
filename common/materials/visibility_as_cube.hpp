// The visibility of materials where every voxel is a cube or empty: levels of detail, maps, and
// files that have no shapes.
#pragma once
#include "common/core/material_row.hpp"
#include "common/core/shape.hpp"
#include "common/core/visibility.hpp"

namespace runstone {

/// Returns the visibility of a cube in place of the shape: `visibility` if the shape is a cube or
/// fills at least half of its voxel, otherwise empty. Requires a valid shape. Cost: O(boxes).
Visibility visibility_as_cube(Visibility visibility, const Shape& shape);
inline Visibility visibility_as_cube(const MaterialRow& row) {
  return visibility_as_cube(row.visibility, row.shape);
}

}  // namespace runstone
