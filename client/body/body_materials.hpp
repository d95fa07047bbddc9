// BodyMaterials: what the materials of a world are to the body of a player.
#pragma once
#include "common/collision/material_set.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Other materials let a body pass. A material that the table does not have is solid.
struct BodyMaterials {
  MaterialSet solid, liquid;
};

BodyMaterials body_materials(const MaterialTable& table);

}  // namespace runstone
