#include "tests/reference/simple_mesher.hpp"

#include "tests/reference/voxel_faces.hpp"

namespace runstone::reference {

void mesh_simple(const DenseGrid& grid, const VisibilityTable& visibility, std::vector<Quad>& out) {
  out.clear();
  const OrderedExtent e = grid.sides();
  for (std::uint32_t s = 0; s < e.s; ++s) {
    for (std::uint32_t m = 0; m < e.m; ++m) {
      const Material* const line = grid.line(m, s);
      for (std::uint32_t f = 0; f < e.f; ++f) {
        if (visibility[line[f]] == Visibility::empty) continue;
        const LocalPos at = from_ordered({f, m, s}, grid.order());
        for (unsigned d = 0; d < kDirectionCount; ++d) {
          out.push_back(face_quad(at, static_cast<Direction>(d), line[f]));
        }
      }
    }
  }
}

}  // namespace runstone::reference
