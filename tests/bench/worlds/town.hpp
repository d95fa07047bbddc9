// Town: a built-up benchmark world on flat ground at y = 0: lots of 16 x 16 voxels between streets, on each a
// house or a garden with a tree. Houses have one to five storeys, floors, rows of windows, a door, and a flat
// or a stepped roof.
#pragma once
#include <span>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone::bench {

/// The voxels (at.x, at.y + i, at.z).
void town_column(VoxelPos at, std::span<Material> out);

}  // namespace runstone::bench
