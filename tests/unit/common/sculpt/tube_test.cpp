#include "common/sculpt/tube.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "common/core/hash.hpp"
#include "common/sculpt/solid.hpp"

namespace runstone::test {
namespace {

/// The rule of the header, tested at one voxel.
bool belongs(const std::vector<CurvePoint>& line, double radius, VoxelPos at) {
  return std::any_of(line.begin(), line.end(), [&](const CurvePoint& p) {
    const double x = at.x + 0.5 - p.x, y = at.y + 0.5 - p.y, z = at.z + 0.5 - p.z;
    const bool holds_point =
        std::floor(p.x) == at.x && std::floor(p.y) == at.y && std::floor(p.z) == at.z;
    return holds_point || x * x + y * y + z * z <= radius * radius + 1e-9;
  });
}

}  // namespace

TEST_CASE("tubes equal the rule for each voxel", "[sculpt]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 24; ++round) {
    const Tube tube{round % 7 + 1, round % 2 == 0 ? TubeBend::curve : TubeBend::straight};
    std::vector<VoxelPos> places;
    const std::int32_t count = rng.between(1, 4);
    for (std::int32_t i = 0; i < count; ++i) {
      places.push_back({static_cast<std::int32_t>(rng.between(-8, 8)),
                        static_cast<std::int32_t>(rng.between(-8, 8)),
                        static_cast<std::int32_t>(rng.between(-8, 8))});
    }
    CAPTURE(Catch::rngSeed(), round);
    const auto placed = tube_build(tube, places, 3);
    REQUIRE(placed);
    const auto line = tube_line(tube, places);
    const VoxelPos at = placed->at, sides = placed->build->sides();
    std::uint64_t count_of_tube = 0, wrong = 0;
    for (std::int32_t z = at.z - 1; z <= at.z + sides.z; ++z) {
      for (std::int32_t y = at.y - 1; y <= at.y + sides.y; ++y) {
        for (std::int32_t x = at.x - 1; x <= at.x + sides.x; ++x) {
          const bool expected = belongs(line, tube.thickness / 2.0, {x, y, z});
          count_of_tube += expected ? 1U : 0U;
          const VoxelPos cell{x - at.x, y - at.y, z - at.z};
          const bool found = placed->build->box().contains(cell) && placed->build->at(cell);
          if (found != expected) ++wrong;
        }
      }
    }
    CHECK(wrong == 0);
    CHECK(placed->build->touched() == count_of_tube);
  }
}

TEST_CASE("a straight tube of two places is a line, and thickness 2 is two voxels wide",
          "[sculpt]") {
  const std::vector<VoxelPos> places = {{0, 0, 0}, {9, 0, 0}};
  const auto thin = tube_build({1, TubeBend::straight}, places, 3);
  REQUIRE(thin);
  CHECK(thin->build->sides() == VoxelPos{10, 1, 1});
  const auto thick = tube_build({2, TubeBend::straight}, places, 3);
  REQUIRE(thick);
  CHECK(thick->build->sides().y == 2);
}

TEST_CASE("a tube that is too long or reaches too far is refused", "[sculpt]") {
  std::vector<VoxelPos> places = {{0, 0, 0}, {1000, 0, 0}, {2000, 0, 0}};
  const auto far = tube_build({1, TubeBend::straight}, places, 3);
  REQUIRE_FALSE(far);
  CHECK(far.error().code == ErrorCode::limit_exceeded);
  places.clear();
  for (int i = 0; i < 10; ++i) places.push_back({i % 2 * 1000, 0, i});
  const auto many = tube_build({1, TubeBend::straight}, places, 3);
  REQUIRE_FALSE(many);
  CHECK(many.error().what == std::string("the curve is longer than 8,192 voxels"));
}

}  // namespace runstone::test
