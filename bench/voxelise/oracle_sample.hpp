// OracleSample: voxels of a result that are compared with the oracle of the tests, which computes
// each of them on its own from all triangles. Half of them are drawn near the surface, where an
// error would be, and half anywhere in the box. The same seed draws the same voxels. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "common/core/coords.hpp"
#include "common/models/model.hpp"
#include "common/voxelise/voxelise.hpp"
#include "tests/support/voxelise/voxel_oracle.hpp"

namespace runstone::bench {

/// The result of a way: the inside (SurfaceMode::none), or a surface.
using OracleShape = SurfaceMode;

class OracleSample {
 public:
  /// Draws voxels of a closed mesh whose longest side becomes `longest_side` voxels. Cost:
  /// O(count * triangles). Requires a mesh in voxelise()'s ranges.
  OracleSample(const Model& mesh, std::uint32_t longest_side, std::size_t count);

  std::size_t count() const { return voxels_.size(); }
  /// Begins to take a result.
  void begin() { is_set_.assign(voxels_.size(), false); }
  /// Takes a piece of the result.
  void take(const VoxelPiece& piece);
  /// Returns the number of voxels of the pieces that differ from the oracle.
  std::size_t differing(OracleShape shape) const;

 private:
  std::vector<VoxelPos> voxels_;
  std::map<VoxelPos, std::vector<std::size_t>> in_section_;  // by the origin of the section
  std::array<std::vector<bool>, 4> expected_;                // by OracleShape
  std::vector<bool> is_set_;
};

}  // namespace runstone::bench
