// BodyMaterials: how the materials of a world act on the body of a player.
#pragma once
#include "common/collision/material_set.hpp"
#include "common/collision/obstacles.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// A material in neither set lets a body pass. A material that the table does not have is solid.
struct BodyMaterials {
  Obstacles solid;
  MaterialSet liquid;  // the whole voxel
};

BodyMaterials body_materials(const MaterialTable& table);

}  // namespace runstone
