#include "client/tools/paste_tool.hpp"

namespace runstone {

ToolEdits PasteTool::plan(const ToolInput& input) const {
  if (!input.clipboard.content) return failure("nothing was copied");
  if (input.button == ToolButton::clear) return failure("paste with the right button");
  const Extent sides = input.clipboard.orientation.rotated(input.clipboard.content->extent());
  const VoxelPos at{input.target.x - sides.x / 2, input.target.y, input.target.z - sides.z / 2};
  return std::vector{EditDescriptor{Paste{at, input.clipboard.content, input.clipboard.orientation},
                                    mask(), kEmpty}};
}

}  // namespace runstone
