// Pose: where a player stands and looks.
#pragma once
#include <cstdint>

#include "common/core/world_pos.hpp"

namespace runstone {

struct Pose {
  WorldPos at;
  std::uint16_t yaw = 0;   // 65536 is a turn; 0 looks along +z; grows towards +x
  std::int16_t pitch = 0;  // 32768 is 180 degrees; positive looks up
  friend bool operator==(const Pose&, const Pose&) = default;
};

}  // namespace runstone
