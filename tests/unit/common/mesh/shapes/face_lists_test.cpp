#include "common/mesh/shapes/face_lists.hpp"

#include <catch2/catch.hpp>

#include "common/mesh/shapes/prepared_shapes.hpp"
#include "common/mesh/shapes/shape_mesher.hpp"

namespace runstone::test {
namespace {

using shape_mesh::FaceLists;
using shape_mesh::kListCount;

/// A shape of 32 bars, which have four sides and two ends each.
Shape upright_bars() {
  Shape out;
  for (std::uint8_t i = 0; i < 32; ++i) {
    const auto x = static_cast<std::uint8_t>(i % 8 * 2);
    const auto z = static_cast<std::uint8_t>(i / 8 * 4);
    out.boxes.push_back(
        {{x, 1, z}, {static_cast<std::uint8_t>(x + 1), 15, static_cast<std::uint8_t>(z + 1)}});
  }
  return out;
}

TEST_CASE("lists of faces grow by the faces that one list gets, not by all of a shape",
          "[mesh][shapes]") {
  const ShapeTable shapes(std::vector<Shape>{{}, upright_bars()});
  for (std::size_t order = 0; order < kAxisOrderCount; ++order) {
    CAPTURE(order);
    shape_mesh::PreparedShapes prepared;
    prepared.begin(shapes, static_cast<AxisOrder>(order));
    const shape_mesh::PreparedShape& shape = prepared.prepare(1);
    CHECK(shape.count == 32 * 6);
    CHECK(shape.most_in_list == 32);
    constexpr std::size_t kLength = 128;
    FaceLists lists;
    lists.begin();
    REQUIRE(lists.make_room(kLength * shape.most_in_list, kLength * shape.count));
    CHECK(lists.capacity() == 2 * kListCount * kLength * 32);
  }
}

TEST_CASE("lists of faces make no room beyond the quads that a chunk shows", "[mesh][shapes]") {
  FaceLists lists;
  lists.begin();
  std::size_t count = 0;
  constexpr std::size_t kInOne = 1'000;
  // Twenty lists get quads, so that no single one has many.
  while (lists.make_room(kInOne, 20 * kInOne)) {
    for (std::size_t list = 0; list < 20; ++list) {
      Quad*& end = lists.pass(false).end[list];
      for (std::size_t i = 0; i < kInOne; ++i) *end++ = {};
      count += kInOne;
    }
    REQUIRE(count < 2 * kShapeQuadsMax);
  }
  CHECK(count >= kShapeQuadsMax);
  CHECK(count < kShapeQuadsMax + kShapeQuadsMax / 16);
}

}  // namespace
}  // namespace runstone::test
