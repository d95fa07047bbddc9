#include "client/render/drawn_materials.hpp"

namespace runstone {

MeshMaterialsPtr mesh_materials_of(const MaterialTable& table) {
  auto out = std::make_shared<MeshMaterials>(VisibilityTable(visibilities(table)));
  out->shapes = ShapeTable(shapes_of(table));
  if (out->shapes.empty()) return out;
  out->cubes = VisibilityTable(cube_visibilities(table));
  out->tiles = VisibilityTable(half_filled_visibilities(table, out->shapes));
  return out;
}

}  // namespace runstone
