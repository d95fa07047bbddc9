// Building tools: the tools with which a player builds, from the single voxel to brushes for
// terrain.
#pragma once
#include <memory>
#include <vector>

#include "client/tools/tool.hpp"

namespace runstone {

/// Returns one of each tool, in the order in which a window lists them. The first one is the voxel
/// tool.
std::vector<std::unique_ptr<Tool>> make_tools();

}  // namespace runstone
