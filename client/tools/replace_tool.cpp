#include "client/tools/replace_tool.hpp"

namespace runstone {

ToolEdits ReplaceTool::plan(const ToolInput& input) const {
  const Mask mask{MaskKind::only_material, input.aim.hit->material};
  const Material material = material_of(input);
  if (material == mask.material) return failure("you hold the material that you look at");
  const std::int32_t radius = value("radius");
  switch (value("where")) {
    case 1: {
      const VoxelPos c = input.target;
      const VoxelBox cube = box_between({c.x - radius, c.y - radius, c.z - radius},
                                        {c.x + radius, c.y + radius, c.z + radius});
      return std::vector{EditDescriptor{FillBox{cube}, mask, material}};
    }
    case 2:
      if (!input.selection) return failure("nothing is selected");
      return std::vector{EditDescriptor{FillBox{*input.selection}, mask, material}};
    default:
      return std::vector{EditDescriptor{
          FillSphere{input.target, static_cast<std::uint16_t>(radius)}, mask, material}};
  }
}

}  // namespace runstone
