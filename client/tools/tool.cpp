#include "client/tools/tool.hpp"

#include <algorithm>

#include "client/tools/box_tool.hpp"
#include "client/tools/extrude_tool.hpp"
#include "client/tools/fill_tool.hpp"
#include "client/tools/paint_tool.hpp"
#include "client/tools/paste_tool.hpp"
#include "client/tools/replace_tool.hpp"
#include "client/tools/select_tool.hpp"
#include "client/tools/sphere_tool.hpp"
#include "client/tools/stroke_tool.hpp"
#include "client/tools/voxel_tool.hpp"
#include "common/core/assert.hpp"

namespace runstone {

Result<void, std::string> Tool::set(std::string_view parameter, std::int32_t value) {
  const auto it = std::find_if(parameters_.begin(), parameters_.end(),
                               [&](const ToolParameter& p) { return p.name == parameter; });
  if (it == parameters_.end()) {
    return failure("the tool " + std::string(name_) + " has no parameter " +
                   std::string(parameter));
  }
  if (value < it->low || value > it->high) {
    return failure(it->name + " must be from " + std::to_string(it->low) + " to " +
                   std::to_string(it->high));
  }
  it->value = value;
  return {};
}

std::int32_t Tool::value(std::string_view parameter) const {
  const auto it = std::find_if(parameters_.begin(), parameters_.end(),
                               [&](const ToolParameter& p) { return p.name == parameter; });
  RUNSTONE_ASSERT(it != parameters_.end());
  return it->value;
}

ToolParameter Tool::mask_parameter() {
  return {"mask", "", 0, 2, 0, {"everything", "empty", "solid"}};
}

Mask Tool::mask() const {
  switch (value("mask")) {
    case 1:
      return {MaskKind::only_empty, kEmpty};
    case 2:
      return {MaskKind::only_solid, kEmpty};
    default:
      return {};
  }
}

std::vector<std::unique_ptr<Tool>> make_tools() {
  std::vector<std::unique_ptr<Tool>> out;
  out.push_back(std::make_unique<VoxelTool>());
  out.push_back(std::make_unique<BoxTool>());
  out.push_back(std::make_unique<SphereTool>());
  out.push_back(std::make_unique<StrokeTool>());
  out.push_back(std::make_unique<FillTool>());
  out.push_back(std::make_unique<ReplaceTool>());
  out.push_back(std::make_unique<PaintTool>());
  out.push_back(std::make_unique<ExtrudeTool>());
  out.push_back(std::make_unique<SelectTool>());
  out.push_back(std::make_unique<PasteTool>());
  return out;
}

}  // namespace runstone
