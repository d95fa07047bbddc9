// Makes the MeshMaterials of a material table, which meshers need.
#pragma once
#include "common/materials/material_table.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

/// Returns the properties of the materials that meshers read. Cost: O(materials), plus the
/// ShapeFaces of each different shape.
MeshMaterialsPtr mesh_materials_of(const MaterialTable& table);

}  // namespace runstone
