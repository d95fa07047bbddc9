// Box parts: what is left of a box without other boxes, as boxes that do not overlap.
#pragma once
#include <cstddef>
#include <vector>

#include "common/core/coords.hpp"

namespace runstone {

/// Takes `hole` out of every part. A part that overlaps it becomes at most 6 parts. Returns false
/// if more than `parts_max` parts are left; then they are unspecified. Requires that no part is
/// empty. Cost: O(parts).
bool cut_out(std::vector<VoxelBox>& parts, const VoxelBox& hole, std::size_t parts_max);

}  // namespace runstone
