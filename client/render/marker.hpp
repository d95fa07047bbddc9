// Marker: a box in world voxels, such as the outline of the picked voxel or of protected ground.
#pragma once
#include <cstdint>

namespace runstone {

struct Marker {
  double x = 0, y = 0, z = 0;  // smallest corner
  double size_x = 1, size_y = 1, size_z = 1;
  std::uint8_t r = 255, g = 255, b = 255;
  bool filled = false;   // false: edges only
  bool crossed = false;  // besides its edges, the diagonals of its faces are drawn
};

}  // namespace runstone
