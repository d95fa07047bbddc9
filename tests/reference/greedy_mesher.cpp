#include "tests/reference/greedy_mesher.hpp"

#include <algorithm>

namespace runstone::reference {
namespace {

/// Returns the rectangle that starts at a face of the plane, as wide as possible and then as high
/// as possible.
PlaneRectangle grow(const FacePlane& plane, std::uint32_t u, std::uint32_t v) {
  const Material* row = plane.row(v) + u;
  const Material material = *row;
  const auto matches = [material](Material face) { return face == material; };
  const Material* const row_end = std::find_if_not(row, row + (plane.width - u), matches);
  const auto width = static_cast<std::uint32_t>(row_end - row);
  std::uint32_t height = 1;
  while (v + height < plane.height) {
    const Material* next = plane.row(v + height) + u;
    if (!std::all_of(next, next + width, matches)) break;
    ++height;
  }
  return {u, v, width, height, material};
}

}  // namespace

void mesh_greedy(const DenseGrid& grid, const VisibilityTable& visibility, GreedyScratch& scratch,
                 std::vector<Quad>& out) {
  out.clear();
  FacePlane& plane = scratch.plane;
  each_face_plane(grid, visibility, plane, [&](Direction direction, std::uint32_t layer) {
    for (std::uint32_t v = 0; v < plane.height; ++v) {
      for (std::uint32_t u = 0; u < plane.width; ++u) {
        if (plane.row(v)[u] == kEmpty) continue;
        const PlaneRectangle r = grow(plane, u, v);
        for (std::uint32_t row = v; row < v + r.height; ++row)
          std::fill_n(plane.row(row) + u, r.width, kEmpty);
        out.push_back(quad_in_plane(direction, layer, r));
      }
    }
  });
}

}  // namespace runstone::reference
