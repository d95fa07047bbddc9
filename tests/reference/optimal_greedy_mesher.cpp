#include "tests/reference/optimal_greedy_mesher.hpp"

namespace runstone::reference {

void mesh_optimal_greedy(const DenseGrid& grid, const VisibilityTable& visibility,
                         OptimalGreedyScratch& scratch, std::vector<Quad>& out) {
  out.clear();
  each_face_plane(grid, visibility, scratch.plane, [&](Direction direction, std::uint32_t layer) {
    scratch.partition.find(scratch.plane, scratch.rectangles);
    for (const PlaneRectangle& r : scratch.rectangles)
      out.push_back(quad_in_plane(direction, layer, r));
  });
}

}  // namespace runstone::reference
