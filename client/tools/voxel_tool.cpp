#include "client/tools/voxel_tool.hpp"

namespace runstone {

ToolEdits VoxelTool::plan(const ToolInput& input) const {
  return std::vector{EditDescriptor{SetVoxel{input.target}, {}, material_of(input)}};
}

}  // namespace runstone
