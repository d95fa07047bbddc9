// BoxTool: fills or clears the box between two corners.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class BoxTool final : public Tool {
 public:
  BoxTool() : Tool("box", "the box between two clicks", {mask_parameter()}) {}
  std::size_t points_before() const override { return 1; }
  std::string_view place_name(std::size_t) const override { return "corner"; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
