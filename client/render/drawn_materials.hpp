// What meshers need of the materials of a world, made of its table.
#pragma once
#include "common/materials/material_table.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

/// Cost: O(materials), and ShapeFaces for each different shape.
MeshMaterialsPtr mesh_materials_of(const MaterialTable& table);

}  // namespace runstone
