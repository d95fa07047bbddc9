// FillTool: replaces or removes the connected surface of one material on the side that the player
// looks at.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class FillTool final : public Tool {
 public:
  FillTool()
      : Tool("fill", "the connected surface of one material",
             {{"voxels", "voxels", 1, 16384, 4096, {}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
