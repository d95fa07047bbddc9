// Material order: the orders in which a palette lists materials. Pure.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

enum class MaterialOrder : std::uint8_t { table, name, colour };

/// Sorts materials of the table:
///   - table: leaves them as they are;
///   - name: by their readable names;
///   - colour: greys from dark to light, then hues from red over green and blue to pink in steps of
///     15 degrees, each from dark to light.
/// Materials with equal names or equal colours are in the order of their numbers.
void sort_materials(std::vector<Material>& materials, const MaterialTable& table,
                    MaterialOrder order);

}  // namespace runstone
