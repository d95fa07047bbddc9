// Strides: the distances of neighbours along each axis in a flattened chunk. With them a read needs
// no table, although the axis order is not known at compile time.
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

/// Returns the index of a voxel from its ordered coordinates.
constexpr VoxelIndex index_of(OrderedPos at, OrderedExtent e) {
  return at.f + e.f * (at.m + e.m * at.s);
}

}  // namespace runstone::bench::storage
