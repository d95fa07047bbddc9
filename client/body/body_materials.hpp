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

/// Returns the solid and the liquid materials of a table. `shapes` are the shapes of the table. If
/// it is a null pointer and a solid material is not a cube, the function makes the shapes. Cost:
/// O(materials), and that of ShapeTable if the function makes the shapes.
BodyMaterials body_materials(const MaterialTable& table, ShapeTablePtr shapes = nullptr);

}  // namespace runstone
