// Corner tools: tools whose clicks choose any number of corners. A second click on the last corner
// completes the action.
#pragma once
#include <memory>

#include "client/tools/tool.hpp"

namespace runstone {

/// Returns the tool that makes a prism over a polygon (common/sculpt/polygon.hpp). A click on the
/// first corner completes it, too.
std::unique_ptr<Tool> make_polygon_tool();

/// Returns the tool that makes a bar along a curve (common/sculpt/tube.hpp).
std::unique_ptr<Tool> make_curve_tool();

/// Returns the tool that puts copies of the clipboard along a curve.
std::unique_ptr<Tool> make_array_tool();

}  // namespace runstone
