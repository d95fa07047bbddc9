// SphereTool: fills or clears a sphere. Its radius is the parameter; with radius 0 the first click
// chooses the centre, and the second one a voxel of the surface.
#pragma once
#include "client/tools/tool.hpp"

namespace runstone {

class SphereTool final : public Tool {
 public:
  SphereTool()
      : Tool("sphere", "a ball; with radius 0 a second click gives its size",
             {{"radius", "voxels", 0, 64, 4, {}}, mask_parameter()}) {}
  std::size_t points_before() const override { return value("radius") == 0 ? 1 : 0; }
  std::string_view place_name(std::size_t i) const override {
    return i == 0 ? "centre" : "place on the surface";
  }
  ToolEdits plan(const ToolInput& input) const override;
};

}  // namespace runstone
