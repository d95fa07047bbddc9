#include "client/tools/box_tool.hpp"

namespace runstone {

ToolEdits BoxTool::plan(const ToolInput& input) const {
  const VoxelPos first = input.points.empty() ? input.target : input.points.front();
  return std::vector{
      EditDescriptor{FillBox{box_between(first, input.target)}, mask(), material_of(input)}};
}

}  // namespace runstone
