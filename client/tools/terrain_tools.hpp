// Terrain tools: brushes that shape the shown ground, and one that scatters the clipboard on it.
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

/// Returns the tool that shapes ground along a stroke (common/sculpt/terrain_brush.hpp).
std::unique_ptr<Tool> make_terrain_tool();

/// Returns the tool that puts copies of the clipboard on the ground along a stroke.
std::unique_ptr<Tool> make_scatter_tool();

}  // namespace runstone
