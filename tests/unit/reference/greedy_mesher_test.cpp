#include "tests/reference/greedy_mesher.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh/text_scene.hpp"

namespace runstone::test {
namespace {

using namespace reference;
using Rectangles = std::vector<PlaneRectangle>;

Rectangles greedy_rectangles(const std::vector<std::string>& rows) {
  GreedyScratch scratch;
  std::vector<Quad> quads;
  mesh_greedy(grid_of(scene_of(rows)), mesh_visibility(), scratch, quads);
  return upper_side(quads);
}

TEST_CASE("greedy: a quad grows as wide as it can, then as high", "[mesh][reference]") {
  CHECK(greedy_rectangles({"111",  //
                           "111",  //
                           "11."}) == Rectangles{{0, 0, 3, 2, 1}, {0, 2, 2, 1, 1}});
  CHECK(greedy_rectangles(
            {"11.",  //
             // The quad is as high as there are whole rows of its width, which may be parts of
             // longer ones.
             "111", "111"}) == Rectangles{{0, 0, 2, 3, 1}, {2, 1, 1, 2, 1}});
}

TEST_CASE("greedy: the first face decides, even where two quads would do", "[mesh][reference]") {
  CHECK(greedy_rectangles({".1.",  //
                           "111"}) ==
        Rectangles{{1, 0, 1, 2, 1}, {0, 1, 1, 1, 1}, {2, 1, 1, 1, 1}});
}

TEST_CASE("greedy: different materials are in different quads", "[mesh][reference]") {
  CHECK(greedy_rectangles({"112",  //
                           "112"}) == Rectangles{{0, 0, 2, 2, 1}, {2, 0, 1, 2, 2}});
  CHECK(greedy_rectangles({"11",  //
                           "12"}) == Rectangles{{0, 0, 2, 1, 1}, {0, 1, 1, 1, 1}, {1, 1, 1, 1, 2}});
}

TEST_CASE("greedy: as many quads as the oracle counts", "[mesh][reference]") {
  SplitMix64 rng(11);
  GreedyScratch scratch;
  std::vector<Quad> quads;
  for (int round = 0; round < 100; ++round) {
    const MeshScene scene = random_scene(rng, 20);
    mesh_greedy(grid_of(scene), mesh_visibility(), scratch, quads);
    REQUIRE(quads.size() == greedy_quad_count(expected_faces(scene)));
  }
}

}  // namespace
}  // namespace runstone::test
