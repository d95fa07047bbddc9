#include "common/map/map_materials.hpp"

namespace runstone {

MapMaterials map_materials(const MaterialTable& table) {
  MapMaterials out;
  for (const MaterialInfo& row : table.rows()) {
    out.showing.push_back(row.visibility != Visibility::empty);
    out.ground.push_back(row.visibility == Visibility::opaque);
    out.colours.push_back(row.colour);
  }
  return out;
}

}  // namespace runstone
