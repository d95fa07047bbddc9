// ReplaceTool: replaces the material that the player looks at, in a sphere or a cube around it or
// in the selection.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class ReplaceTool final : public Tool {
 public:
  ReplaceTool()
      : Tool("replace", "the material in sight by the one in the hand",
             {{"where", "", 0, 2, 0, {"sphere", "cube", "selection"}},
              {"radius", "voxels", 1, 64, 8, {}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
