// DirtyLayers: the layers of a chunk in which voxels changed.
#pragma once
#include <array>
#include <bitset>
#include <cstddef>

#include "common/runs/extent.hpp"

namespace runstone {

/// The layers in which a voxel changed, per axis x, y, z: bit i is the layer with that coordinate =
/// i. The faces to mesh again lie in these layers and, per axis, one layer to either side (in the
/// neighbour chunk at the border).
struct DirtyLayers {
  std::array<std::bitset<kSideMax>, 3> layer;
  bool any() const { return layer[0].any(); }
  DirtyLayers& operator|=(const DirtyLayers& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) layer[axis] |= other.layer[axis];
    return *this;
  }
  friend bool operator==(const DirtyLayers&, const DirtyLayers&) = default;
};

}  // namespace runstone
