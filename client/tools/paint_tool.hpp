// PaintTool: changes the material of the surface voxels in a sphere. Empty voxels stay empty.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class PaintTool final : public Tool {
 public:
  PaintTool()
      : Tool("paint", "the surface around the aim, not the air",
             {{"radius", "voxels", 0, 12, 3, {}}}) {}
  bool chooses_solid() const override { return true; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
