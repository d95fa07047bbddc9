#include "server/map/build_picture.hpp"

#include <algorithm>
#include <vector>

#include "common/core/assert.hpp"
#include "common/map/map_painter.hpp"
#include "common/map/map_tops.hpp"
#include "common/materials/visibility_as_cube.hpp"
#include "server/map/map_png.hpp"

namespace runstone {
namespace {

/// Returns the facts about cell numbers: 0 is an untouched cell, which shows nothing.
MapMaterials facts_of(const std::vector<BuildMaterial>& materials) {
  MapMaterials out;
  out.showing.push_back(false);
  out.ground.push_back(false);
  out.colours.push_back({});
  for (const BuildMaterial& material : materials) {
    const Visibility visibility = visibility_as_cube(material.row);
    out.showing.push_back(visibility != Visibility::empty);
    out.ground.push_back(visibility == Visibility::opaque);
    out.colours.push_back(material.row.colour);
  }
  return out;
}

}  // namespace

RsbResult<std::string> build_picture(RsbReader& reader, std::int32_t side_max) {
  RUNSTONE_ASSERT(side_max >= 1 && side_max <= kBuildPictureSideMax);
  const BuildSides& sides = reader.info().sides;
  const auto width = static_cast<std::int32_t>(std::max(sides.x, sides.z));
  const std::int32_t unit = (width + side_max - 1) / side_max;  // voxels along a pixel
  MapTops tops((width + unit - 1) / unit);
  const MapMaterials materials = facts_of(reader.materials());
  std::vector<ColumnTop> found;  // of a section
  while (true) {
    const auto section = reader.next();
    if (!section) return failure(section.error());
    if (!section->has_value()) break;
    const RunChunk& cells = (*section)->cells;
    const VoxelPos corner = section_corner((*section)->at);
    found.assign(std::size_t{cells.extent.x} * cells.extent.z, {});
    find_column_tops(cells, corner.y, materials.showing, found);
    for (std::int32_t z = 0; z < cells.extent.z; ++z) {
      for (std::int32_t x = 0; x < cells.extent.x; ++x) {
        ColumnTop top = found[static_cast<std::size_t>(x + cells.extent.x * z)];
        if (!top.is_found()) continue;
        top.y /= unit;
        const std::int32_t column = (corner.x + x) / unit + tops.edge * ((corner.z + z) / unit);
        ColumnTop& highest = tops.surface[static_cast<std::size_t>(column)];
        // The order of sections is that of their numbers, so equal heights have one winner.
        if (!highest.is_found() || highest.y < top.y) highest = top;
      }
    }
  }
  return png_of(paint_map(tops, {}, {}, materials), tops.edge);
}

}  // namespace runstone
