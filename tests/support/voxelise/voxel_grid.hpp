// VoxelGrid: the result of the voxeliser with a number for each voxel, for comparison.
#pragma once
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/voxelise/voxelise.hpp"

namespace runstone::test {

struct VoxelGrid {
  Voxelised result;
  std::vector<Material> cells;  // x fastest, then y
  Material at(VoxelPos p) const {
    const VoxelPos s = result.sides;
    return cells[static_cast<std::size_t>(p.x + s.x * (p.y + s.y * p.z))];
  }
  /// Calls f(voxel, material) for each voxel.
  template <class F>
  void for_each(F&& f) const {
    const VoxelPos s = result.sides;
    for (VoxelPos p; p.z < s.z; ++p.z) {
      for (p.y = 0; p.y < s.y; ++p.y) {
        for (p.x = 0; p.x < s.x; ++p.x) f(p, at(p));
      }
    }
  }
};

/// Voxelises a model, and expands it. Fails as voxelise(), and with broken_invariant if a piece is
/// not canonical, is empty, or comes out of order, or if the count of voxels is wrong.
Result<VoxelGrid> voxel_grid(const Model& model, const VoxeliseOptions& options,
                             const ParallelFor& parallel_for = {});

}  // namespace runstone::test
