#include "tests/reference/naive_greedy_mesher.hpp"

#include <catch2/catch.hpp>

#include "tests/reference/greedy_mesher.hpp"
#include "tests/reference/grid_rdm.hpp"
#include "tests/support/mesh/text_scene.hpp"

namespace runstone::test {
namespace {

using namespace reference;
using Rectangles = std::vector<PlaneRectangle>;

template <class Scratch, class Mesher>
Rectangles rectangles_of(const std::vector<std::string>& rows, Mesher mesher) {
  Scratch scratch;
  std::vector<Quad> quads;
  mesher(grid_of(scene_of(rows)), mesh_visibility(), scratch, quads);
  return upper_side(quads);
}

Rectangles naive(const std::vector<std::string>& rows) {
  return rectangles_of<NaiveGreedyScratch>(rows, mesh_naive_greedy);
}
Rectangles greedy(const std::vector<std::string>& rows) {
  return rectangles_of<GreedyScratch>(rows, mesh_greedy);
}
Rectangles grid_rdm(const std::vector<std::string>& rows) {
  return rectangles_of<GridRdmScratch>(rows, mesh_grid_rdm);
}

TEST_CASE("naive greedy: quads begin at the leftmost face, whatever lies above",
          "[mesh][reference]") {
  const std::vector<std::string> step = {".1",  //
                                         "11",  //
                                         "1."};
  CHECK(naive(step) == Rectangles{{0, 1, 2, 1, 1}, {0, 2, 1, 1, 1}, {1, 0, 1, 1, 1}});
  CHECK(greedy(step).size() == 2);
  const std::vector<std::string> shape = {".1.",  //
                                          "111"};
  CHECK(naive(shape) == Rectangles{{0, 1, 3, 1, 1}, {1, 0, 1, 1, 1}});
  CHECK(greedy(shape).size() == 3);
}

TEST_CASE("naive greedy: a next row may be longer, which Grid RDM does not join",
          "[mesh][reference]") {
  const std::vector<std::string> shape = {"1.",  //
                                          "11",  //
                                          "1."};
  CHECK(naive(shape) == Rectangles{{0, 0, 1, 3, 1}, {1, 1, 1, 1, 1}});
  CHECK(grid_rdm(shape).size() == 3);
}

TEST_CASE("naive greedy: a row that does not fit is put back whole", "[mesh][reference]") {
  CHECK(naive({"1111",  //
               "1121",  // both ends fit
               "1111"}) ==
        Rectangles{
            {0, 0, 4, 1, 1}, {0, 1, 2, 2, 1}, {2, 1, 1, 1, 2}, {2, 2, 2, 1, 1}, {3, 1, 1, 1, 1}});
}

}  // namespace
}  // namespace runstone::test
