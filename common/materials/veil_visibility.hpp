// The visibilities of materials for the veil of chunks (common/veil).
#pragma once
#include <vector>

#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the visibility of each material by id. A material counts as opaque only if it is an
/// opaque cube that stops a body and light, so that no voxel behind it can be seen, reached or lit.
/// Other opaque cubes count as transparent, and materials with a shape as empty.
std::vector<Visibility> veil_visibilities(const MaterialTable& table);

}  // namespace runstone
