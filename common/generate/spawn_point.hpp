// The spawn point: the place where players enter a generated world.
#pragma once
#include "common/core/coords.hpp"
#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the voxel in which the eyes of a new player are: Generator::spawn() if the generator
/// knows a place, otherwise two above the surface of a column near x = z = 0. That is the column at
/// the origin unless a transparent material covers it, as the sea does. Then it is the nearest
/// column, on a grid of 8 voxels and at most 1024 voxels away on each axis, that is opaque on top
/// and has opaque columns on all four sides. If there is no such column, it is the one at the
/// origin. Cost: O(columns tried), about 66,000 if there is no land.
VoxelPos spawn_point(const Generator& generator, const MaterialTable& materials);
/// Returns true if spawn_point() is in the column at the origin because no transparent material
/// covers it. Cost: one column.
bool is_origin_dry(const Generator& generator, const MaterialTable& materials);

}  // namespace runstone
