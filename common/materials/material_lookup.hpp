// The search for a material by the name that a person types.
#pragma once
#include <string>
#include <string_view>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the material of that name. If there is none, returns the only material whose name ends
/// with ':' and `name`: "stone" finds "default:stone". Fails with one line of text if no material
/// matches, or if several do; the line lists up to eight of them. Cost: O(materials).
Result<Material, std::string> find_material(const MaterialTable& table, std::string_view name);

}  // namespace runstone
