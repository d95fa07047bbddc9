#include "common/mesh/rdm/quad_shape.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/mesh/rdm/side_axes.hpp"

namespace runstone::rdm {
namespace {

/// The quads of one direction, and the axes of its strips and rows.
struct ShapeCase {
  Direction direction;
  StripAxes axes;
  QuadShape shape;
};

/// Calls f(ShapeCase) for all directions in all axis orders.
template <class F>
void for_each_shape(F&& f) {
  for (const AxisOrder order : kAxisOrders) {
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const StripAxes axes = strip_axes(order, axis_of(direction));
      f(ShapeCase{direction, axes, QuadShape(direction, axes.strip, axes.row)});
    }
  }
}

/// Packs a quad by its fields, not by a QuadShape. The strip is the one of `strip`, and it has
/// `rows` rows.
Quad packed(const ShapeCase& at, const Strip& strip, std::uint32_t rows, Material material) {
  std::array<std::uint8_t, 3> corner{};
  corner.at(static_cast<std::size_t>(at.axes.layer)) = static_cast<std::uint8_t>(strip.layer);
  corner.at(static_cast<std::size_t>(at.axes.strip)) = static_cast<std::uint8_t>(strip.begin);
  corner.at(static_cast<std::size_t>(at.axes.row)) = static_cast<std::uint8_t>(strip.row);
  const bool along_u = u_axis_of(at.axes.layer) == at.axes.strip;
  return pack({corner[0], corner[1], corner[2],
               static_cast<std::uint8_t>(along_u ? strip.length : rows),
               static_cast<std::uint8_t>(along_u ? rows : strip.length), at.direction, material});
}

/// Calls f(strip, rows) for strips at the ends of a side of 128 faces, and for random ones.
template <class F>
void for_each_strip(F&& f) {
  for (const std::uint32_t begin : {0u, 127u}) {
    f(Strip{0, begin, 128 - begin, 0}, 128u);
    f(Strip{127, begin, 128 - begin, 127}, 1u);
    f(Strip{127, begin, 1, 0}, 1u);
  }
  SplitMix64 rng(20261201);
  for (int i = 0; i < 50; ++i) {
    const std::uint32_t begin = rng.below(128), row = rng.below(128);
    f(Strip{rng.below(128), begin, 1 + rng.below(128 - begin), row}, 1 + rng.below(128 - row));
  }
}

TEST_CASE("a strip that opens and closes is the quad of its rectangle", "[mesh]") {
  for_each_shape([](const ShapeCase& at) {
    for_each_strip([&](const Strip& strip, std::uint32_t rows) {
      const Quad quad = packed(at, strip, rows, 65535);
      REQUIRE(at.shape.close(at.shape.open(strip, 65535), strip.row + rows) == quad);
      REQUIRE(at.shape.row(quad) == strip.row);
      REQUIRE(at.shape.rows(quad) == rows);
      REQUIRE(at.shape.row_end(quad) == strip.row + rows);
      REQUIRE(at.shape.first(quad) == strip.begin);
      REQUIRE(at.shape.last(quad) == strip.begin + strip.length - 1);
    });
  });
}

TEST_CASE("a quad that is opened again closes at another row, and keeps its mark", "[mesh]") {
  for_each_shape([](const ShapeCase& at) {
    for_each_strip([&](const Strip& strip, std::uint32_t rows) {
      const Quad quad = packed(at, strip, rows, 7);
      for (const std::uint64_t mark : {std::uint64_t{0}, kTransparentQuad}) {
        const Quad open = {at.shape.reopen(quad).bits ^ mark};
        REQUIRE(open == Quad{at.shape.open(strip, 7).bits ^ mark});
        REQUIRE(at.shape.close(open, strip.row + 1).bits == (packed(at, strip, 1, 7).bits ^ mark));
        REQUIRE(at.shape.close(open, 128).bits ==
                (packed(at, strip, 128 - strip.row, 7).bits ^ mark));
      }
    });
  });
}

TEST_CASE("a quad is cut into rows, which join again", "[mesh]") {
  for_each_shape([](const ShapeCase& at) {
    const Quad quad = packed(at, {5, 10, 20, 40}, 3, 9);
    Quad joined = at.shape.piece(quad, 10, 40);
    CHECK(joined == packed(at, {5, 10, 20, 40}, 1, 9));
    for (const std::uint32_t row : {41u, 42u}) {
      const Quad next = at.shape.piece(quad, 10, row);
      REQUIRE(at.shape.joins(joined, next));
      joined = at.shape.with_row_more(joined);
    }
    CHECK(joined == quad);
    // A piece may begin elsewhere. It ends where its quad ends.
    CHECK(at.shape.piece(quad, 29, 41) == packed(at, {5, 29, 1, 41}, 1, 9));
    CHECK(at.shape.piece(quad, 0, 127) == packed(at, {5, 0, 30, 127}, 1, 9));
  });
}

TEST_CASE("quads of different strips or materials, or apart from each other, do not join",
          "[mesh]") {
  for_each_shape([](const ShapeCase& at) {
    const Quad above = packed(at, {5, 10, 20, 40}, 2, 9);
    CHECK(at.shape.joins(above, packed(at, {5, 10, 20, 42}, 3, 9)));
    CHECK_FALSE(at.shape.joins(above, packed(at, {5, 10, 20, 43}, 3, 9)));
    CHECK_FALSE(at.shape.joins(above, packed(at, {5, 10, 20, 41}, 3, 9)));
    CHECK_FALSE(at.shape.joins(above, packed(at, {5, 11, 20, 42}, 3, 9)));
    CHECK_FALSE(at.shape.joins(above, packed(at, {5, 10, 21, 42}, 3, 9)));
    CHECK_FALSE(at.shape.joins(above, packed(at, {6, 10, 20, 42}, 3, 9)));
    CHECK_FALSE(at.shape.joins(above, packed(at, {5, 10, 20, 42}, 3, 8)));
  });
}

}  // namespace
}  // namespace runstone::rdm
