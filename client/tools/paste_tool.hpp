// PasteTool: puts the clipboard against the place that the player looks at. Its lowest layer stands
// there, with the place in the middle.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class PasteTool final : public Tool {
 public:
  PasteTool() : Tool("paste", "puts the clipboard down", {mask_parameter()}) {}
  std::string_view place_name(std::size_t) const override { return "middle of the lowest layer"; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
