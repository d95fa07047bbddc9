// The tool that copies the voxels that belong together, and cuts them (common/sculpt/wand.hpp).
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

std::unique_ptr<Tool> make_wand_tool();

}  // namespace runstone
