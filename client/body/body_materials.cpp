#include "client/body/body_materials.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace runstone {

BodyMaterials body_materials(const MaterialTable& table, ShapeTablePtr shapes) {
  std::vector<bool> cubes, shaped, liquid;
  bool has_shapes = false;
  for (const MaterialInfo& row : table.rows()) {
    const bool is_there = row.visibility != Visibility::empty;
    const bool is_solid = is_there && row.body == MaterialBody::solid;
    cubes.push_back(is_solid && row.shape.is_cube());
    shaped.push_back(is_solid && !row.shape.is_cube());
    has_shapes = has_shapes || shaped.back();
    liquid.push_back(is_there && row.body == MaterialBody::liquid);
  }
  MaterialSet in_liquid(std::move(liquid), false), of_cubes(std::move(cubes), true);
  if (!has_shapes) return {std::move(of_cubes), std::move(in_liquid)};
  if (!shapes) shapes = std::make_shared<const ShapeTable>(shapes_of(table));
  return {Obstacles(std::move(of_cubes), MaterialSet(std::move(shaped), false), std::move(shapes)),
          std::move(in_liquid)};
}

}  // namespace runstone
