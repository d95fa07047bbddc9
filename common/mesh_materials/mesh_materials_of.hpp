// Makes MeshMaterials, which meshers need, of the material table of a world.
#pragma once
#include "common/materials/material_table.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

/// Cost: O(materials), and ShapeFaces for each different shape.
MeshMaterialsPtr mesh_materials_of(const MaterialTable& table);

}  // namespace runstone
