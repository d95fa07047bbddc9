// Village: the town with shapes, as an imported build has them: panes in the windows, roofs of
// stairs and slabs, fences around the lots, plants in the gardens, and carpets and furniture on the
// floors.
#pragma once
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/shape.hpp"
#include "common/core/visibility.hpp"

namespace runstone::bench {

/// Writes the voxels (at.x, at.y + i, at.z).
void village_column(VoxelPos at, std::span<Material> out);

/// Return the visibility and the shape of each material. Those of the town are cubes.
std::vector<Visibility> village_visibilities();
std::vector<Shape> village_shapes();

}  // namespace runstone::bench
