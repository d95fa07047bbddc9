// The tool that writes a line of text as voxels (client/lettering/text_build.hpp).
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

std::unique_ptr<Tool> make_text_tool();

}  // namespace runstone
