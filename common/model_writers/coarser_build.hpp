// Coarser builds: the levels of detail of a model that is written. Level k has cells of 2^k voxels,
// and each level is made of the one before it by the rule of tiles (common/tiles/tile_builder.hpp).
// A cell in which any voxel shows is not empty, so a coarse level covers the fine one. Voxels with
// a shape count as the cubes in their place (WrittenMaterial::as_cube). Thread: any.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/result.hpp"
#include "common/model_writers/model_writing.hpp"

namespace runstone {

/// A coarser build, with materials by palette entry of its own.
struct CoarserBuild {
  BuildPtr build;
  /// By palette entry: the cell number of its material in the finer build.
  std::vector<std::uint16_t> finer_numbers;
};

/// Returns true if a build has a side of more than one cell.
bool can_be_coarser(const Build& build);

/// Returns a build with cells of 2 x 2 x 2 cells of the source. Its sides are half as long, rounded
/// up, and its lowest corner is that of the source. Fails with limit_exceeded if it takes more
/// than `bytes_max` of memory, and with bad_value if it shows nothing, because the source shows no
/// cube. Cost: that of cells_in() and build_tile() for each cube of 256 cells.
Result<CoarserBuild> coarser_build(const WrittenBuild& source, std::size_t bytes_max);

}  // namespace runstone
