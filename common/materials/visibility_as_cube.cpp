#include "common/materials/visibility_as_cube.hpp"

#include "common/shapes/shape_faces.hpp"

namespace runstone {

Visibility visibility_as_cube(Visibility visibility, const Shape& shape) {
  constexpr unsigned kHalf = kShapeUnits * kShapeUnits * kShapeUnits / 2;
  return shape.is_cube() || filled_cells(shape) >= kHalf ? visibility : Visibility::empty;
}

}  // namespace runstone
