#include "common/shapes/shape_table.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

Shape one_box(std::uint8_t height) { return {ShapeForm::boxes, {{{0, 0, 0}, {16, height, 16}}}}; }

}  // namespace

TEST_CASE("a table of cubes is empty", "[shapes]") {
  CHECK(ShapeTable().empty());
  const ShapeTable cubes(std::vector<Shape>(3));
  CHECK(cubes.empty());
  CHECK(cubes.is_cube(2));
  CHECK(cubes.is_cube(65535));
}

TEST_CASE("materials of equal shapes share one entry, and entries ascend", "[shapes]") {
  const std::vector<Shape> shapes = {Shape{}, one_box(8), one_box(4), Shape{}, one_box(8)};
  const ShapeTable table(shapes);
  CHECK_FALSE(table.empty());
  REQUIRE(table.shapes().size() == 2);
  CHECK(table.shapes()[0].shape == one_box(4));
  CHECK(table.shapes()[1].shape == one_box(8));
  CHECK(table.number(1) == 2);
  CHECK(table.number(2) == 1);
  CHECK(table.number(4) == 2);
  CHECK(table.is_cube(0));
  CHECK(table.is_cube(3));
  CHECK(table.is_cube(5));
  CHECK(&table[1] == &table[4]);
  CHECK(table[2].faces.faces().size() == 6);
}

}  // namespace runstone::test
