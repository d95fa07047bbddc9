// Shapes whose fewest rectangles are known by inspection.
#include "tests/reference/minimum_partition.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh/partition_oracle.hpp"
#include "tests/support/mesh/text_scene.hpp"

namespace runstone::test {
namespace {

using namespace reference;

std::size_t rectangles_in(const std::vector<std::string>& rows) {
  static MinimumPartition partition;  // the remains of one plane would show in the next
  const FacePlane plane = plane_of(rows);
  std::vector<PlaneRectangle> rectangles;
  partition.find(plane, rectangles);
  CHECK(partition_fault(plane, rectangles) == "");
  CHECK(rectangles.size() == least_rectangles_by_formula(plane));
  return rectangles.size();
}

TEST_CASE("minimum partition: nothing, one rectangle, and one cut a concave corner",
          "[mesh][reference]") {
  CHECK(rectangles_in({"...", "..."}) == 0);
  CHECK(rectangles_in({"1"}) == 1);
  CHECK(rectangles_in({"111", "111"}) == 1);
  CHECK(rectangles_in({"111", "1.."}) == 2);
  CHECK(rectangles_in({".11", "11."}) == 2);
}

TEST_CASE("minimum partition: a chord is the cut of two corners", "[mesh][reference]") {
  CHECK(rectangles_in({".1.",  //
                       "111"}) == 2);
  CHECK(rectangles_in({".1.",  // two chords along u or two along v
                       "111",  //
                       ".1."}) == 3);
}

TEST_CASE("minimum partition: of chords that cross, the larger set is cut", "[mesh][reference]") {
  CHECK(rectangles_in({".1.1.",  // three along v, crossed by one along u at either side
                       "11111",  //
                       ".1.1."}) == 5);
  CHECK(rectangles_in({".1111.",  //
                       "111111",  //
                       "11..11",  //
                       "111111",  //
                       ".1111."}) == 6);
}

TEST_CASE("minimum partition: holes", "[mesh][reference]") {
  CHECK(rectangles_in({"111",  //
                       "1.1",  //
                       "111"}) == 4);
  CHECK(rectangles_in({"11111",  // a chord from hole to hole
                       "1.1.1",  //
                       "11111"}) == 5);
  CHECK(rectangles_in({"1111",  // holes that touch at a corner are one
                       "1.11",  //
                       "11.1",  //
                       "1111"}) == 6);
}

TEST_CASE("minimum partition: shapes that touch at a corner only stay apart", "[mesh][reference]") {
  CHECK(rectangles_in({"1.", ".1"}) == 2);
  CHECK(rectangles_in({"11..",  //
                       "11..",  //
                       "..11",  //
                       "..11"}) == 2);
  CHECK(rectangles_in({"1111",  // one shape that touches itself
                       "1..1",  //
                       "1.11",  //
                       "11.."}) == 5);
}

TEST_CASE("minimum partition: materials are shapes of their own", "[mesh][reference]") {
  CHECK(rectangles_in({"1122", "1122"}) == 2);
  CHECK(rectangles_in({"121",  //
                       "222",  //
                       "121"}) == 4 + 3);
  CHECK(rectangles_in({"1112", "1222", "3332"}) == 2 + 2 + 1);
}

}  // namespace
}  // namespace runstone::test
