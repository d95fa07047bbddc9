#include "common/shapes/shape_faces.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

const Shape kSlab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};

}  // namespace

TEST_CASE("a slab has six faces, and its lower side is full", "[shapes]") {
  const ShapeFaces faces(kSlab);
  const std::vector<ShapeFace> expected = {
      {Direction::neg_x, 0, 0, 0, 8, 0, 16},  {Direction::pos_x, 16, 16, 0, 8, 0, 16},
      {Direction::neg_y, 0, 0, 0, 16, 0, 16}, {Direction::pos_y, 8, 8, 0, 16, 0, 16},
      {Direction::neg_z, 0, 0, 0, 16, 0, 8},  {Direction::pos_z, 16, 16, 0, 16, 0, 8},
  };
  CHECK(std::equal(faces.faces().begin(), faces.faces().end(), expected.begin(), expected.end()));
  CHECK(faces.side(Direction::neg_y).all());
  CHECK(faces.side(Direction::pos_y).none());
  CHECK(faces.side(Direction::neg_x).count() == 128);
  CHECK(faces.side(Direction::neg_x)[7]);  // v = z = 0, u = y = 7
  CHECK_FALSE(faces.side(Direction::neg_x)[8]);
  CHECK(filled_cells(kSlab) == 2048);
  CHECK(is_on_border(faces.faces()[0]));
  CHECK(is_on_border(faces.faces()[1]));
  CHECK_FALSE(is_on_border(faces.faces()[3]));
}

TEST_CASE("two boxes that touch have no face between them", "[shapes]") {
  const Shape shape{ShapeForm::boxes, {{{0, 0, 0}, {8, 16, 16}}, {{8, 0, 0}, {16, 16, 16}}}};
  const ShapeFaces faces(shape);
  CHECK(faces.faces().size() == 6);
  CHECK(filled_cells(shape) == 4096);
}

TEST_CASE("crossed planes are seen from both sides and fill nothing", "[shapes]") {
  const Shape shape{ShapeForm::crossed, {{{1, 0, 2}, {15, 12, 14}}}};
  const ShapeFaces faces(shape);
  const std::vector<ShapeFace> expected = {
      {Direction::neg_x, 1, 15, 0, 12, 2, 14},
      {Direction::neg_x, 15, 1, 0, 12, 2, 14},
      {Direction::pos_x, 1, 15, 0, 12, 2, 14},
      {Direction::pos_x, 15, 1, 0, 12, 2, 14},
  };
  CHECK(std::equal(faces.faces().begin(), faces.faces().end(), expected.begin(), expected.end()));
  CHECK(filled_cells(shape) == 0);
  for (int d = 0; d < kDirectionCount; ++d) CHECK(faces.side(static_cast<Direction>(d)).none());
  for (const ShapeFace& face : faces.faces()) {
    CHECK_FALSE(face.is_flat());
    CHECK_FALSE(is_on_border(face));
  }
}

}  // namespace runstone::test
