// GivenShape: a shape that a row of the material table gets after it was added. It is the one
// change of a row that there is, and each row has it once.
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
