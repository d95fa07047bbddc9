// The material of a world that looks most like one that the world lacks.
#pragma once
#include "common/core/ids.hpp"
#include "common/core/material_row.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the material that looks most like a row: of those with the same visibility, or of all that
/// are not empty if there is none, the one with the nearest colour; of equal ones the lowest id.
/// Returns 0 if the table has nothing but empty materials. Cost: O(table).
Material nearest_material(const MaterialRow& row, const MaterialTable& table);

}  // namespace runstone
