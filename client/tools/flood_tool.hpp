// The tool that fills a hollow up to a level, as a liquid would (common/builds/basin_flood.hpp).
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

std::unique_ptr<Tool> make_flood_tool();

}  // namespace runstone
