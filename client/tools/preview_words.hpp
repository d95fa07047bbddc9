// Preview words: what the next click does, in numbers for the player.
#pragma once
#include <string>

#include "client/tools/tool_box.hpp"

namespace runstone {

/// Returns how many voxels the next click sets, removes, copies, selects or deselects, as its
/// preview counts them. Requires a preview that is complete.
std::string preview_words(const ToolBox& box);

}  // namespace runstone
