#include "tests/reference/culled_mesher.hpp"

#include <array>

#include "tests/reference/voxel_faces.hpp"

namespace runstone::reference {

void mesh_culled(const DenseGrid& grid, const VisibilityTable& visibility, std::vector<Quad>& out) {
  out.clear();
  const OrderedExtent e = grid.sides();
  std::array<std::ptrdiff_t, kDirectionCount> beside{};
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    beside[d] =
        is_positive(direction) ? grid.stride(axis_of(direction)) : -grid.stride(axis_of(direction));
  }
  for (std::uint32_t s = 0; s < e.s; ++s) {
    for (std::uint32_t m = 0; m < e.m; ++m) {
      const Material* voxel = grid.line(m, s);
      for (std::uint32_t f = 0; f < e.f; ++f, ++voxel) {
        if (visibility[*voxel] == Visibility::empty) continue;
        const LocalPos at = from_ordered({f, m, s}, grid.order());
        for (unsigned d = 0; d < kDirectionCount; ++d) {
          if (visibility.face_drawn(*voxel, voxel[beside[d]])) {
            out.push_back(face_quad(at, static_cast<Direction>(d), *voxel));
          }
        }
      }
    }
  }
}

CulledPhases mesh_culled(const MaterialOctree& octree, VoxelPos first, Extent extent,
                         const VisibilityTable& visibility, Clock now, DenseGrid& grid,
                         std::vector<Quad>& out) {
  const std::uint64_t start = now();
  grid.reset(extent, AxisOrder::xyz);
  octree.sample(first, grid);
  const std::uint64_t sampled = now();
  mesh_culled(grid, visibility, out);
  const std::uint64_t meshed = now();
  return {sampled - start, meshed - sampled};
}

}  // namespace runstone::reference
