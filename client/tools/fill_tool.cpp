#include "client/tools/fill_tool.hpp"

#include "client/tools/cell_list.hpp"
#include "client/tools/surface_flood.hpp"

namespace runstone {

ToolEdits FillTool::plan(const ToolInput& input) const {
  SurfaceFlood flood;
  flood.face = *input.aim.hit->face;
  flood.follows_steps = true;
  flood.voxels_max = static_cast<std::size_t>(value("voxels"));
  std::vector<Cell> cells;
  for (const VoxelPos at : flood_surface(input.replica, input.target, flood))
    cells.push_back({at, material_of(input)});
  auto paste = paste_of(std::move(cells), {});
  if (!paste) return failure(paste.error());
  return std::vector{*std::move(paste)};
}

}  // namespace runstone
