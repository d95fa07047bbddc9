#include "bench/storage/ball.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "common/core/hash.hpp"

using namespace runstone;
using bench::storage::Ball;

TEST_CASE("the rows of a ball are its voxels inside the chunk, in index order, once each",
          "[storage]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int step = 0; step < 200; ++step) {
    const Extent extent = Extent::cube(8u << rng.below(2));
    const auto along = [&] { return static_cast<std::uint8_t>(rng.below(extent.x)); };
    const std::uint8_t x = along(), y = along();
    const LocalPos centre = {x, y, along()};
    const auto radius = static_cast<std::int32_t>(rng.below(Ball::kRadiusMax + 1));
    const AxisOrder order = kAxisOrders[rng.below(kAxisOrderCount)];
    CAPTURE(Catch::rngSeed(), step, radius);
    const Ball ball(centre, radius);
    std::set<LocalPos> rows, plain;
    std::uint32_t next = 0;
    ball.for_each_row(extent, order, [&](OrderedPos first, std::uint32_t count) {
      for (std::uint32_t i = 0; i < count; ++i) {
        const LocalPos at = from_ordered({first.f + i, first.m, first.s}, order);
        REQUIRE(index_of(at, extent, order) >= next);
        next = index_of(at, extent, order) + 1;
        rows.insert(at);
      }
    });
    for (int z = 0; z < extent.z; ++z) {
      for (int cy = 0; cy < extent.y; ++cy) {
        for (int cx = 0; cx < extent.x; ++cx) {
          const int dx = cx - centre.x, dy = cy - centre.y, dz = z - centre.z;
          const bool inside =
              4 * (dx * dx + dy * dy + dz * dz) < (2 * radius + 1) * (2 * radius + 1);
          REQUIRE(ball.contains(cx, cy, z) == inside);
          if (inside) {
            plain.insert({static_cast<std::uint8_t>(cx), static_cast<std::uint8_t>(cy),
                          static_cast<std::uint8_t>(z)});
          }
        }
      }
    }
    REQUIRE(rows == plain);
  }
}

TEST_CASE("the position of a ball relative to a cube follows from its voxels", "[storage]") {
  SplitMix64 rng{Catch::rngSeed()};
  int seen[3] = {};
  for (int step = 0; step < 20'000; ++step) {
    const auto along = [&](unsigned below) { return static_cast<std::uint8_t>(rng.below(below)); };
    const std::uint8_t x = along(12), y = along(12);  // near the cube
    const Ball ball({x, y, along(12)}, static_cast<std::int32_t>(rng.below(Ball::kRadiusMax + 1)));
    const unsigned side = 1u << rng.below(4);
    const std::uint8_t low_x = along(12), low_y = along(12);
    const LocalPos low = {low_x, low_y, along(12)};
    unsigned inside = 0;
    for (unsigned i = 0; i < side * side * side; ++i) {
      const auto at = [&](unsigned first, unsigned rank) {
        return static_cast<int>(first + rank % side);
      };
      inside +=
          ball.contains(at(low.x, i), at(low.y, i / side), at(low.z, i / side / side)) ? 1 : 0;
    }
    const Ball::Against against = ball.against(low, static_cast<std::int32_t>(side));
    ++seen[static_cast<int>(against)];
    CAPTURE(Catch::rngSeed(), step);
    if (against == Ball::Against::covers) REQUIRE(inside == side * side * side);
    // A cube without any of the voxels may still count as cut: then none of its parts has any.
    if (against == Ball::Against::apart) REQUIRE(inside == 0);
    if (inside == side * side * side) REQUIRE(against == Ball::Against::covers);
  }
  CHECK(seen[0] > 100);
  CHECK(seen[1] > 100);
  CHECK(seen[2] > 100);
}
