// The liquids of a table, by material, for code that treats them as a set, and the liquids whose
// surface is lower than their cubes.
#pragma once
#include <vector>

#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns by id which materials are liquids that are not empty. Cost: O(materials).
inline std::vector<bool> liquids(const MaterialTable& table) {
  std::vector<bool> out;
  out.reserve(table.size());
  for (const MaterialInfo& row : table.rows())
    out.push_back(row.body == MaterialBody::liquid && row.visibility != Visibility::empty);
  return out;
}

/// Returns true for the liquids whose surface is lower than their cubes: the transparent ones. An
/// opaque liquid hides the faces of its neighbours, which a lower surface would show.
inline bool has_lowered_surface(const MaterialInfo& row) {
  return row.body == MaterialBody::liquid && row.visibility == Visibility::transparent &&
         row.colour[3] < 255 && row.shape.is_cube();
}

}  // namespace runstone
