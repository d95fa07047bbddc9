// StrokeTool: draws a line as thick as a sphere of its radius along the places over which the
// player moves the aim while the button is held. The whole line is one edit.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class StrokeTool final : public Tool {
 public:
  StrokeTool()
      : Tool("stroke", "a line, as long as the button is held",
             {{"radius", "voxels", 1, 32, 2, {}}, mask_parameter()}) {}
  bool is_drawn() const override { return true; }
  std::string_view place_name(std::size_t) const override { return "place"; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
