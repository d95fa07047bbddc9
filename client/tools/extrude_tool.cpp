#include "client/tools/extrude_tool.hpp"

#include "client/tools/cell_list.hpp"
#include "client/tools/shown_voxels.hpp"
#include "client/tools/surface_flood.hpp"

namespace runstone {
namespace {

/// Bounds the work while the player moves the aim.
constexpr std::size_t kCellsMax = 65'536;

}  // namespace

ToolEdits ExtrudeTool::plan(const ToolInput& input) const {
  const Direction face = *input.aim.hit->face;
  const std::int32_t depth = value("depth");
  SurfaceFlood flood;
  flood.face = face;
  flood.same_material = value("material") == 1;
  flood.voxels_max = static_cast<std::size_t>(value("voxels"));
  const bool is_outward = input.button == ToolButton::place;
  const std::vector<VoxelPos> surface = flood_surface(input.replica, input.target, flood);
  if (surface.size() * static_cast<std::size_t>(depth) > kCellsMax)
    return failure("the change has more than 65,536 voxels");
  ShownVoxels voxels(input.replica);
  std::vector<Cell> cells;
  for (const VoxelPos at : surface) {
    const Material material = is_outward ? voxels.at(at).value_or(kEmpty) : kEmpty;
    for (std::int32_t i = 0; i < depth; ++i)
      cells.push_back({moved(at, face, is_outward ? i + 1 : -i), material});
  }
  const Mask mask = is_outward ? Mask{MaskKind::only_empty, kEmpty} : Mask{};
  auto paste = paste_of(std::move(cells), mask);
  if (!paste) return failure(paste.error());
  return std::vector{*std::move(paste)};
}

}  // namespace runstone
