// Strides: how far neighbours along each axis lie apart in a flattened chunk. An axis order that is not known
// when the program is compiled then costs a read no table.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone::bench::storage {

class Strides {
 public:
  Strides(Extent extent, AxisOrder order)
      : x_(index_of({1, 0, 0}, extent, order)),
        y_(index_of({0, 1, 0}, extent, order)),
        z_(index_of({0, 0, 1}, extent, order)) {}
  VoxelIndex index(LocalPos at) const { return at.x * x_ + at.y * y_ + at.z * z_; }

 private:
  std::uint32_t x_, y_, z_;
};

/// Index of a voxel by its ordered coordinates.
constexpr VoxelIndex index_of(OrderedPos at, OrderedExtent e) {
  return at.f + e.f * (at.m + e.m * at.s);
}

}  // namespace runstone::bench::storage
