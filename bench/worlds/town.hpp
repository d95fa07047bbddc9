// Town: a built-up benchmark world on flat ground at y = 0. Lots of 16 x 16 voxels lie between
// streets. A lot has a house, or a garden with a tree. A house has one to five storeys, floors,
// rows of windows, a door, and a flat or stepped roof.
#pragma once
#include <span>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone::bench {

/// Writes the voxels (at.x, at.y + i, at.z).
void town_column(VoxelPos at, std::span<Material> out);

}  // namespace runstone::bench
