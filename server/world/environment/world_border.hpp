// The border of a world: the box within which players may edit, as text.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/coords.hpp"

namespace runstone {

/// Returns true if the border leaves every height free.
inline bool has_all_heights(const VoxelBox& border) {
  return border.min.y <= -kWorldLimit && border.max.y >= kWorldLimit;
}

/// Returns the box as text such as "x -500 to 499, z -500 to 499", both included. The heights are left
/// out if all of them are inside.
inline std::string border_text(const VoxelBox& border) {
  const auto range = [](const char* name, std::int32_t min, std::int32_t max) {
    return std::string(name) + " " + std::to_string(min) + " to " + std::to_string(max - 1);
  };
  std::string text = range("x", border.min.x, border.max.x) + ", ";
  if (!has_all_heights(border)) text += range("y", border.min.y, border.max.y) + ", ";
  return text + range("z", border.min.z, border.max.z);
}

}  // namespace runstone
