// SelectTool: chooses the box between two voxels as the selection.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class SelectTool final : public Tool {
 public:
  SelectTool() : Tool("select", "two corners choose a box", {}) {}
  std::size_t points_before() const override { return 1; }
  bool chooses_solid() const override { return true; }
  bool selects() const override { return true; }
  std::string_view place_name(std::size_t) const override { return "corner"; }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
