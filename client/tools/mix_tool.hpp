// The tool that gives the voxels of a box the materials of a pattern (common/patterns).
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

std::unique_ptr<Tool> make_mix_tool();

}  // namespace runstone
