#include "tests/reference/optimal_greedy_mesher.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh/partition_oracle.hpp"
#include "tests/support/mesh/text_scene.hpp"

namespace runstone::test {
namespace {

using namespace reference;

TEST_CASE("optimal greedy: two quads where greedy takes three", "[mesh][reference]") {
  OptimalGreedyScratch scratch;
  std::vector<Quad> quads;
  mesh_optimal_greedy(grid_of(scene_of({".1.", "111"})), mesh_visibility(), scratch, quads);
  CHECK(upper_side(quads) == std::vector<PlaneRectangle>{{1, 0, 1, 1, 1}, {0, 1, 3, 1, 1}});
}

TEST_CASE("optimal greedy: each layer of each direction needs what the formula says",
          "[mesh][reference]") {
  SplitMix64 rng(13);
  OptimalGreedyScratch scratch;
  FacePlane plane;
  std::vector<Quad> quads;
  for (int round = 0; round < 60; ++round) {
    const MeshScene scene = random_scene(rng, 14);
    const DenseGrid grid = grid_of(scene);
    mesh_optimal_greedy(grid, mesh_visibility(), scratch, quads);
    std::size_t least = 0;
    each_face_plane(grid, mesh_visibility(), plane,
                    [&](Direction, std::uint32_t) { least += least_rectangles_by_formula(plane); });
    REQUIRE(quads.size() == least);
  }
}

}  // namespace
}  // namespace runstone::test
