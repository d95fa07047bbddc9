// Scattered places: on dry ground without plants, far enough apart, and equal for equal seeds.
#include "common/sculpt/scatter.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <vector>

#include "tests/unit/common/sculpt/hills.hpp"

namespace runstone::test {
namespace {

std::vector<ScatteredSpot> spots_on_hills(const Scattering& scattering,
                                          const std::vector<VoxelPos>& places) {
  const Hills& hills = Hills::shared();
  VoxelBox box = scatter_box(scattering, places);
  box.min.y = std::max(box.min.y, Hills::kLow);
  box.max.y = std::min(box.max.y, Hills::kHigh);
  const auto columns = GroundColumns::read(box, kHillEdge, hills);
  REQUIRE(columns);
  return scattered_spots(*columns, GroundMaterials::of(hills.table), scattering, places);
}

const std::vector<VoxelPos> kScatterLine = {{-20, 8, 3}, {5, 9, 10}, {11, 6, -14}};

}  // namespace

TEST_CASE("places lie on the surface, and never under water or a plant", "[sculpt][scatter]") {
  const Hills& hills = Hills::shared();
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const ScatteredSpot& spot : spots_on_hills({24, 2, seed}, kScatterLine)) {
      ++count;
      const VoxelPos at = spot.ground;
      if (at.y != hills.height(at.x, at.z))
        FAIL_CHECK("not the surface at " << at.x << " " << at.z);
      if (hills.at({at.x, at.y + 1, at.z}) != kEmpty)
        FAIL_CHECK("covered: " << at.x << " " << at.z);
    }
  }
  CHECK(count > 100);
}

TEST_CASE("all pairs of places are farther apart than the spacing", "[sculpt][scatter]") {
  const std::int32_t spacing = GENERATE(1, 3, 8);
  const auto spots = spots_on_hills({24, spacing, 5}, kScatterLine);
  REQUIRE(spots.size() > 3);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const VoxelPos a = spots[i].ground, b = spots[j].ground;
      if (std::max(std::abs(a.x - b.x), std::abs(a.z - b.z)) <= spacing)
        FAIL_CHECK(a.x << " " << a.z << " is too close to " << b.x << " " << b.z);
    }
  }
}

TEST_CASE("equal seeds give equal places, also for another stroke over the ground",
          "[sculpt][scatter]") {
  const auto spots = spots_on_hills({16, 3, 5}, kScatterLine);
  CHECK(spots == spots_on_hills({16, 3, 5}, kScatterLine));
  CHECK(spots != spots_on_hills({16, 3, 6}, kScatterLine));
  const auto wider = spots_on_hills({24, 3, 5}, kScatterLine);
  CHECK(wider.size() > spots.size());
  for (const ScatteredSpot& spot : spots) CHECK(std::ranges::count(wider, spot) == 1);
}

TEST_CASE("a scattering ends one place beyond the bound", "[sculpt][scatter]") {
  CHECK(spots_on_hills({64, 1, 1}, {{0, 8, 0}}).size() == kScatteredMax + 1);
}

}  // namespace runstone::test
