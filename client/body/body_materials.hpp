// BodyMaterials: how the materials of a world act on the body of a player.
#pragma once
#include "common/collision/material_set.hpp"
#include "common/collision/obstacles.hpp"
#include "common/materials/material_table.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// A material in neither set lets a body pass. A material that the table does not have is solid.
struct BodyMaterials {
  Obstacles solid;
  MaterialSet liquid;  // the whole voxel
};

/// Returns those of a table. `shapes` are its shapes; null: the function makes them, if a body
/// meets any. Cost: O(materials), and for null that of ShapeTable.
BodyMaterials body_materials(const MaterialTable& table, ShapeTablePtr shapes = nullptr);

}  // namespace runstone
