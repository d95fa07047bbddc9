// The visibilities of materials for the veil of chunks (common/veil).
#pragma once
#include <vector>

#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the visibility of each material by id. Only the materials count as opaque behind which
/// nothing can be seen, reached or lit: opaque cubes that stop a body and light. Other opaque cubes
/// count as transparent, and materials with a shape as empty.
std::vector<Visibility> veil_visibilities(const MaterialTable& table);

}  // namespace runstone
