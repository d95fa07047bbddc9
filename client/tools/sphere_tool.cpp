#include "client/tools/sphere_tool.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {

ToolEdits SphereTool::plan(const ToolInput& input) const {
  VoxelPos centre = input.target;
  std::int32_t radius = value("radius");
  if (radius == 0 && !input.points.empty()) {
    centre = input.points.front();
    const auto square = [](std::int32_t a, std::int32_t b) {
      const double d = static_cast<double>(a) - b;
      return d * d;
    };
    const double distance =
        std::sqrt(square(input.target.x, centre.x) + square(input.target.y, centre.y) +
                  square(input.target.z, centre.z));
    radius = static_cast<std::int32_t>(
        std::lround(std::min(distance, static_cast<double>(kEditRadiusMax))));
  }
  return std::vector{EditDescriptor{FillSphere{centre, static_cast<std::uint16_t>(radius)}, mask(),
                                    material_of(input)}};
}

}  // namespace runstone
