#include "tests/reference/naive_greedy_mesher.hpp"

#include <algorithm>

namespace runstone::reference {
namespace {

/// Takes faces of `material` from `row` on, up to `most`. Returns their number.
std::uint32_t take_run(Material* row, std::uint32_t most, Material material) {
  std::uint32_t taken = 0;
  while (taken < most && row[taken] == material) row[taken++] = kEmpty;
  return taken;
}

/// Takes `width` faces of `material` from `row` on, or none. Returns true if it took them.
bool take_row(Material* row, std::uint32_t width, Material material) {
  if (row[0] != material || row[width - 1] != material) return false;
  const std::uint32_t taken = take_run(row, width, material);
  if (taken == width) return true;
  std::fill_n(row, taken, material);
  return false;
}

}  // namespace

void mesh_naive_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                       NaiveGreedyScratch& scratch, std::vector<Quad>& out) {
  out.clear();
  FacePlane& plane = scratch.plane;
  each_face_plane(grid, visibility, plane, [&](Direction direction, std::uint32_t layer) {
    for (std::uint32_t u = 0; u < plane.width; ++u) {
      for (std::uint32_t v = 0; v < plane.height; ++v) {
        const Material material = plane.row(v)[u];
        if (material == kEmpty) continue;
        const std::uint32_t width = take_run(plane.row(v) + u, plane.width - u, material);
        std::uint32_t height = 1;
        while (v + height < plane.height && take_row(plane.row(v + height) + u, width, material))
          ++height;
        out.push_back(quad_in_plane(direction, layer, {u, v, width, height, material}));
      }
    }
  });
}

}  // namespace runstone::reference
