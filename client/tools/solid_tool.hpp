// The tool that fills the box between two clicks with a solid (common/sculpt/solid.hpp).
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

std::unique_ptr<Tool> make_solid_tool();

}  // namespace runstone
