#include "client/tools/stroke_tool.hpp"

namespace runstone {

ToolEdits StrokeTool::plan(const ToolInput& input) const {
  const auto radius = static_cast<std::uint16_t>(value("radius"));
  if (input.points.size() < 2) {
    const VoxelPos centre = input.points.empty() ? input.target : input.points.front();
    return std::vector{EditDescriptor{FillSphere{centre, radius}, mask(), material_of(input)}};
  }
  FillStroke stroke{{input.points.begin(), input.points.end()}, radius};
  return std::vector{EditDescriptor{std::move(stroke), mask(), material_of(input)}};
}

}  // namespace runstone
