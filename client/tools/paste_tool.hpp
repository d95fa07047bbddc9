// PasteTool: pastes the clipboard at the place that the player looks at. The place is the middle of
// the lowest layer.
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
