// Palette: materials for builders that a world, for example an imported one, may lack.
#pragma once
#include <cstddef>

#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Appends the materials of `palette` that find_material() does not find in `table`, in their
/// order, and returns how many these are. The ids of the table's own materials stay. So
/// find_material() finds every name of the palette afterwards, and a world with "default:glass"
/// gets no second glass. Fails with limit_exceeded, and appends nothing, if not all of them fit.
/// Cost: O(materials of both, multiplied).
Result<std::size_t> append_palette(MaterialTable& table, const MaterialTable& palette);

}  // namespace runstone
