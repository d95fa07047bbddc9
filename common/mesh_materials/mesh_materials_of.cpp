#include "common/mesh_materials/mesh_materials_of.hpp"

#include "common/materials/liquids.hpp"

namespace runstone {

MeshMaterialsPtr mesh_materials_of(const MaterialTable& table) {
  auto out = std::make_shared<MeshMaterials>(VisibilityTable(visibilities(table)));
  out->shapes = ShapeTable(shapes_of(table));
  for (std::size_t id = 0; id < table.size(); ++id) {
    const MaterialInfo& row = table[static_cast<Material>(id)];
    if (!has_lowered_surface(row)) continue;
    out->liquids.resize(table.size());
    out->liquids[id] = true;
  }
  if (out->shapes.empty()) return out;
  out->cubes = VisibilityTable(cube_visibilities(table));
  out->tiles = VisibilityTable(half_filled_visibilities(table));
  return out;
}

}  // namespace runstone
