// Terrain tools: brushes that shape the shown ground, lay ways on it and scatter the clipboard.
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

/// Returns the tool that shapes ground along a stroke (common/sculpt/terrain_brush.hpp).
std::unique_ptr<Tool> make_terrain_tool();

/// Returns the tool that lays a way along a curve (common/sculpt/path_brush.hpp).
std::unique_ptr<Tool> make_path_tool();

/// Returns the tool that puts copies of the clipboard on the ground along a stroke.
std::unique_ptr<Tool> make_scatter_tool();

}  // namespace runstone
