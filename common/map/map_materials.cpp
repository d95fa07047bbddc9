#include "common/map/map_materials.hpp"

#include "common/materials/visibility_as_cube.hpp"

namespace runstone {

MapMaterials map_materials(const MaterialTable& table) {
  MapMaterials out;
  for (const MaterialInfo& row : table.rows()) {
    const Visibility visibility = visibility_as_cube(row.visibility, row.shape);
    out.showing.push_back(visibility != Visibility::empty);
    out.ground.push_back(visibility == Visibility::opaque);
    out.colours.push_back(row.colour);
  }
  return out;
}

}  // namespace runstone
