// The liquids of a table, by material, for code that treats them as a set.
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

}  // namespace runstone
