// GivenShape: the shape that a material of a world gets after its row was made, once.
#pragma once
#include "common/core/ids.hpp"
#include "common/core/shape.hpp"

namespace runstone {

struct GivenShape {
  Material material = kEmpty;
  Shape shape;  // no cube
  friend bool operator==(const GivenShape&, const GivenShape&) = default;
};

}  // namespace runstone
