// Body: another player, drawn by BodyPainter as boxes in the player's colour.
#pragma once
#include <cstdint>

namespace runstone {

struct Body {
  double x = 0, y = 0, z = 0;  // middle of the feet, world voxels
  double yaw = 0, pitch = 0;   // direction of sight, radians, as those of Camera
  std::uint8_t r = 255, g = 255, b = 255;
};

}  // namespace runstone
