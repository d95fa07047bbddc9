// Texts for the player about builds: the reason why one cannot be made, and its size.
#pragma once
#include <string>

#include "common/builds/build.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns why a build cannot be copied or made, for the player. A limit is named with its value and
/// with what to do.
std::string words_of(const Error& error);

/// Returns a line such as "512 x 96 x 512 voxels, 3.1 MB".
std::string size_text(const Build& build);

/// Returns true if a box with this lowest corner and these sides lies in the world.
bool is_in_world(VoxelPos at, VoxelPos sides);

}  // namespace runstone
