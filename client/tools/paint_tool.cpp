#include "client/tools/paint_tool.hpp"

#include "client/tools/cell_list.hpp"
#include "client/tools/shown_voxels.hpp"

namespace runstone {
namespace {

/// Returns true if a voxel beside this one is empty.
bool is_exposed(ShownVoxels& voxels, VoxelPos at) {
  for (int d = 0; d < kDirectionCount; ++d) {
    if (voxels.at(moved(at, static_cast<Direction>(d), 1)) == std::optional<Material>(kEmpty))
      return true;
  }
  return false;
}

}  // namespace

ToolEdits PaintTool::plan(const ToolInput& input) const {
  if (input.button == ToolButton::clear) return failure("paint with the right button");
  const std::int32_t radius = value("radius");
  ShownVoxels voxels(input.replica);
  std::vector<Cell> cells;
  for (std::int32_t z = -radius; z <= radius; ++z) {
    for (std::int32_t y = -radius; y <= radius; ++y) {
      for (std::int32_t x = -radius; x <= radius; ++x) {
        if (x * x + y * y + z * z > radius * radius + radius) continue;
        const VoxelPos at{input.target.x + x, input.target.y + y, input.target.z + z};
        const auto material = voxels.at(at);
        if (!material || *material == kEmpty || *material == input.aim.held) continue;
        if (is_exposed(voxels, at)) cells.push_back({at, input.aim.held});
      }
    }
  }
  // Another player may clear a voxel before the edit is ordered: then the voxel stays empty.
  auto paste = paste_of(std::move(cells), {MaskKind::only_solid, kEmpty});
  if (!paste) return failure(paste.error());
  return std::vector{*std::move(paste)};
}

}  // namespace runstone
