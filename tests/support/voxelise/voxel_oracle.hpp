// VoxelOracle: the voxels of a mesh, each found on its own from all triangles, in exact arithmetic
// of 128 bits. It shares no code with the voxeliser, and uses other tests: rays along z instead of
// rows along x, edges and corners of cubes instead of separating axes, and the solid angle of each
// triangle.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/models/model.hpp"
#include "common/voxelise/voxelise.hpp"

namespace runstone::test {

class VoxelOracle {
 public:
  /// `voxels_per_unit` of the voxeliser, without a turn. Requires a mesh in voxelise()'s ranges.
  VoxelOracle(const Model& mesh, double voxels_per_unit);

  VoxelPos sides() const { return sides_; }
  /// Returns true if a voxel is in the surface.
  bool is_surface(VoxelPos voxel, SurfaceMode mode) const;
  /// Returns true if a voxel is not inside, and a triangle crosses the line from its centre to that
  /// of a neighbour that is not inside either, and does so within the voxel. Requires a closed
  /// mesh.
  bool is_wall(VoxelPos voxel) const;
  /// Returns true if the ray from the centre of a voxel along +z meets an odd number of triangles.
  bool is_inside(VoxelPos voxel) const;
  /// Returns the signed number of triangles that the ray meets.
  int crossings(VoxelPos voxel) const;
  /// Returns the winding number of the centre of a voxel, or nullopt if it is on a triangle.
  std::optional<double> winding(VoxelPos voxel) const;

 private:
  std::vector<std::array<std::array<std::int64_t, 3>, 3>> triangles_;  // units of 1/256 voxel
  VoxelPos sides_;
};

}  // namespace runstone::test
