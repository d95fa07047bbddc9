#include "common/shapes/turned_shape.hpp"

#include <bitset>
#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

// Boxes without any symmetry.
const Shape kCrooked{ShapeForm::boxes, {{{0, 1, 2}, {5, 9, 16}}, {{7, 0, 3}, {8, 16, 4}}}};

using CellsOfVoxel = std::bitset<4096>;

CellsOfVoxel cells_of(const Shape& shape) {
  CellsOfVoxel out;
  for (const ShapeBox& box : shape.boxes) {
    for (std::size_t x = box.min[0]; x < box.max[0]; ++x) {
      for (std::size_t y = box.min[1]; y < box.max[1]; ++y) {
        for (std::size_t z = box.min[2]; z < box.max[2]; ++z) out[x + 16 * (y + 16 * z)] = true;
      }
    }
  }
  return out;
}

constexpr std::array<std::array<Axis, 3>, 6> kAllAxes = {{
    {Axis::x, Axis::y, Axis::z},
    {Axis::x, Axis::z, Axis::y},
    {Axis::y, Axis::x, Axis::z},
    {Axis::y, Axis::z, Axis::x},
    {Axis::z, Axis::x, Axis::y},
    {Axis::z, Axis::y, Axis::x},
}};

}  // namespace

TEST_CASE("a turned shape fills the turned cells", "[shapes]") {
  const CellsOfVoxel before = cells_of(kCrooked);
  for (const auto& along : kAllAxes) {
    for (std::uint8_t flips = 0; flips < 8; ++flips) {
      CellsOfVoxel expected;
      for (std::size_t x = 0; x < 16; ++x) {
        for (std::size_t y = 0; y < 16; ++y) {
          for (std::size_t z = 0; z < 16; ++z) {
            // The cell (x, y, z) of the world is this cell of the shape.
            const std::array<std::size_t, 3> world = {x, y, z};
            std::array<std::size_t, 3> own{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
              own[static_cast<std::size_t>(along[axis])] =
                  (flips >> axis & 1) != 0 ? 15 - world[axis] : world[axis];
            }
            expected[x + 16 * (y + 16 * z)] = before[own[0] + 16 * (own[1] + 16 * own[2])];
          }
        }
      }
      const Shape after = turned(kCrooked, along, flips);
      CAPTURE(static_cast<int>(along[0]), static_cast<int>(along[1]), static_cast<int>(flips));
      CHECK(validate_shape(after));
      CHECK(cells_of(after) == expected);
    }
  }
}

TEST_CASE("quarter turns about y go from north to east", "[shapes]") {
  const Shape north{ShapeForm::boxes, {{{0, 0, 0}, {15, 1, 2}}}};
  CHECK(turned_about_y(north, 1) == Shape{ShapeForm::boxes, {{{14, 0, 0}, {16, 1, 15}}}});
  CHECK(turned_about_y(north, 2) == Shape{ShapeForm::boxes, {{{1, 0, 14}, {16, 1, 16}}}});
  CHECK(turned_about_y(north, 3) == Shape{ShapeForm::boxes, {{{0, 0, 1}, {2, 1, 16}}}});
  CHECK(turned_about_y(kCrooked, 4) == kCrooked);
  CHECK(turned_about_y(turned_about_y(kCrooked, 3), 1) == kCrooked);
}

TEST_CASE("crossed planes stay upright", "[shapes]") {
  const Shape plant{ShapeForm::crossed, {{{1, 0, 2}, {15, 12, 14}}}};
  CHECK(turned_about_y(plant, 1) == Shape{ShapeForm::crossed, {{{2, 0, 1}, {14, 12, 15}}}});
  CHECK(turned(plant, {Axis::x, Axis::y, Axis::z}, 2) ==
        Shape{ShapeForm::crossed, {{{1, 4, 2}, {15, 16, 14}}}});
  CHECK(turned(plant, {Axis::y, Axis::x, Axis::z}, 0) == plant);
}

}  // namespace runstone::test
