// The baseline of the voxeliser: a grid of one byte a voxel. It finds the same crossings, marks
// them in the grid, fills the rows between the marks, and makes the runs of each section of the
// filled grid.
#pragma once
#include <cstdint>

#include "common/models/model.hpp"
#include "common/voxelise/voxelise.hpp"

namespace runstone::bench {

/// Gives what voxelise() gives for a solid with one colour by parity. Requires a closed mesh.
Result<Voxelised> dense_voxelise(const Model& model, const VoxeliseOptions& options,
                                 const VoxelPieceSink& sink);

}  // namespace runstone::bench
