// ExtrudeTool: moves the connected flat face that the player looks at outward or inward.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class ExtrudeTool final : public Tool {
 public:
  ExtrudeTool()
      : Tool("extrude", "pushes a flat face out, or in",
             {{"depth", "voxels", 1, 64, 1, {}},
              {"voxels", "voxels", 1, 16384, 4096, {}},
              {"material", "", 0, 1, 0, {"any", "same"}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
