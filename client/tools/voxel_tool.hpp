// VoxelTool: sets or removes one voxel.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class VoxelTool final : public Tool {
 public:
  VoxelTool() : Tool("voxel", "one voxel; hold the button for more", {}) {}
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
