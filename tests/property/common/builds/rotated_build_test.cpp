#include "common/builds/rotated_build.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "common/builds/build_transforms.hpp"
#include "tests/support/builds/cell_grid.hpp"

namespace runstone::test {
namespace {

/// Rotates the middle of a cell back about the middle of the box, from the sentence in the header.
/// Sets `is_near_border` if the place is so near to the border of a cell that rounding decides.
VoxelPos place_before(const BuildRotation& rotation, VoxelPos old, VoxelPos made, VoxelPos cell,
                      bool& is_near_border) {
  const double angle = -rotation.degrees * std::numbers::pi / 180, scale = rotation.percent / 100.0;
  const double x = (cell.x + 0.5 - made.x / 2.0) / scale, y = (cell.y + 0.5 - made.y / 2.0) / scale,
               z = (cell.z + 0.5 - made.z / 2.0) / scale;
  // Along the axis, both boxes begin at the same place.
  const auto along = [&](std::int32_t v) { return (v + 0.5) / scale; };
  const double c = std::cos(angle), s = std::sin(angle);
  double bx = 0, by = 0, bz = 0;
  if (rotation.axis == Axis::y) {
    bx = x * c + z * s + old.x / 2.0;
    bz = z * c - x * s + old.z / 2.0;
    by = along(cell.y);
  } else if (rotation.axis == Axis::x) {
    by = y * c + z * s + old.y / 2.0;
    bz = z * c - y * s + old.z / 2.0;
    bx = along(cell.x);
  } else {
    bx = x * c + y * s + old.x / 2.0;
    by = y * c - x * s + old.y / 2.0;
    bz = along(cell.z);
  }
  for (const double v : {bx, by, bz}) is_near_border |= std::abs(v - std::round(v)) < 1e-6;
  return {static_cast<std::int32_t>(std::floor(bx)), static_cast<std::int32_t>(std::floor(by)),
          static_cast<std::int32_t>(std::floor(bz))};
}

}  // namespace

TEST_CASE("rotated builds equal the rule for each cell", "[builds][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 60; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const VoxelPos sides{rng.between(1, 40), rng.between(1, 30), rng.between(1, 90)};
    const CellGrid cells = random_cells(rng, sides, 4);
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, sides, 30));
    const BuildRotation rotation{static_cast<Axis>(rng.between(0, 2)), rng.between(-400, 400),
                                 round % 3 == 0 ? 100 : rng.between(kScaleMin, 250)};
    const auto made = rotated_build(*build, rotation);
    const VoxelPos wide = rotated_sides(rotation, sides);
    CHECK(wide.x <= static_cast<std::int32_t>(std::ceil(130.0 * rotation.percent / 100)) + 1);
    std::uint64_t touched = 0, wrong = 0;
    for_each_cell(wide, [&](VoxelPos cell) {
      bool is_near_border = false;
      const VoxelPos from = place_before(rotation, sides, wide, cell, is_near_border);
      const GridCell expected = build->box().contains(from) ? cells.at(from) : std::nullopt;
      const GridCell found = made ? (*made)->at(cell) : std::nullopt;
      touched += found ? 1U : 0U;
      if (!is_near_border && found != expected) ++wrong;
    });
    CHECK(wrong == 0);
    if (!made) {
      CHECK(made.error().code == ErrorCode::bad_value);
      continue;
    }
    CHECK((*made)->sides() == wide);
    CHECK((*made)->touched() == touched);
    CHECK(broken_invariant(**made) == "");
  }
}

TEST_CASE("quarter turns about y lose no cell and equal turned()", "[builds][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int quarters = -5; quarters <= 5; ++quarters) {
    const VoxelPos sides{rng.between(1, 70), rng.between(1, 20), rng.between(1, 70)};
    const CellGrid cells = random_cells(rng, sides, 5);
    const BuildPtr build = build_of_cells(rng, cells, random_cuts(rng, sides, 40));
    const auto made = rotated_build(*build, {Axis::y, 90 * quarters, 100});
    REQUIRE(made);
    CHECK(cells_of(**made) == turned_cells(cells, Orientation{}.rotated_about_y(quarters)));
  }
}

TEST_CASE("a rotated build that is too long is refused", "[builds]") {
  SplitMix64 rng{1};
  const VoxelPos sides{300, 2, 2};
  const BuildPtr build =
      build_of_cells(rng, random_cells(rng, sides, 2), random_cuts(rng, sides, 60));
  const auto made = rotated_build(*build, {Axis::y, 0, 1000});
  REQUIRE_FALSE(made);
  CHECK(made.error().code == ErrorCode::limit_exceeded);
}

}  // namespace runstone::test
