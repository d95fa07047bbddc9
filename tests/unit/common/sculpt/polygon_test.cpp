#include "common/sculpt/polygon.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "common/core/hash.hpp"

namespace runstone::test {
namespace {

/// Returns true if the column is on the line of a side, by the rule of the header.
bool is_on_line(VoxelPos a, VoxelPos b, std::int32_t x, std::int32_t z) {
  if (std::abs(a.x - b.x) < std::abs(a.z - b.z)) {
    std::swap(a.x, a.z);
    std::swap(b.x, b.z);
    std::swap(x, z);
  }
  if (x < std::min(a.x, b.x) || x > std::max(a.x, b.x)) return false;
  if (a.x == b.x) return z == a.z;
  // The distance across, times the length: from -1/2 (excluded) to 1/2.
  const std::int64_t length = std::abs(b.x - a.x), sign = b.x > a.x ? 1 : -1;
  const std::int64_t off = (z - a.z) * length - sign * (x - a.x) * (b.z - a.z);
  return 2 * off > -length && 2 * off <= length;
}

/// Casts a ray along x.
bool is_inside(const std::vector<VoxelPos>& corners, std::int32_t x, std::int32_t z) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const VoxelPos a = corners[i], b = corners[(i + 1) % corners.size()];
    if ((a.z > z) == (b.z > z)) continue;
    const std::int64_t side =
        std::int64_t{x - a.x} * (b.z - a.z) - std::int64_t{z - a.z} * (b.x - a.x);
    if ((b.z > a.z) == (side < 0)) inside = !inside;
  }
  return inside;
}

bool is_filled(const std::vector<VoxelPos>& corners, std::int32_t x, std::int32_t z) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (is_on_line(corners[i], corners[(i + 1) % corners.size()], x, z)) return true;
  }
  return is_inside(corners, x, z);
}

bool belongs(const Prism& prism, const std::vector<VoxelPos>& corners, VoxelPos at) {
  if (!is_filled(corners, at.x, at.z)) return false;
  const std::int32_t y = at.y - corners.front().y;
  if (prism.fill == SolidFill::solid) return true;
  if (prism.fill == SolidFill::hollow && (y < prism.wall || y >= prism.height - prism.wall))
    return true;
  for (std::int32_t dz = -prism.wall; dz <= prism.wall; ++dz) {
    for (std::int32_t dx = -prism.wall; dx <= prism.wall; ++dx) {
      if (!is_filled(corners, at.x + dx, at.z + dz)) return true;
    }
  }
  return false;
}

void check(const Prism& prism, const std::vector<VoxelPos>& corners) {
  const auto placed = polygon_build(prism, corners, 5);
  REQUIRE(placed);
  const VoxelPos at = placed->at, sides = placed->build->sides();
  CHECK(at.y == corners.front().y);
  CHECK(sides.y == prism.height);
  std::uint64_t count = 0, wrong = 0;
  for (std::int32_t z = at.z - 1; z <= at.z + sides.z; ++z) {
    for (std::int32_t y = at.y; y < at.y + sides.y; ++y) {
      for (std::int32_t x = at.x - 1; x <= at.x + sides.x; ++x) {
        const bool expected = belongs(prism, corners, {x, y, z});
        count += expected ? 1U : 0U;
        const VoxelPos cell{x - at.x, y - at.y, z - at.z};
        const bool found = placed->build->box().contains(cell) && placed->build->at(cell);
        if (found != expected) ++wrong;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(placed->build->touched() == count);
}

}  // namespace

TEST_CASE("polygons equal the rule for each voxel", "[sculpt]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 60; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const std::int32_t side = round % 3 == 0 ? 80 : 14;
    std::vector<VoxelPos> corners;
    const std::int32_t count = rng.between(1, 9);
    for (std::int32_t i = 0; i < count; ++i) {
      corners.push_back({static_cast<std::int32_t>(rng.between(-side, side)),
                         static_cast<std::int32_t>(rng.between(-5, 5)),
                         static_cast<std::int32_t>(rng.between(-side, side))});
    }
    const auto fill = static_cast<SolidFill>(rng.between(0, kSolidFillCount - 1));
    check({static_cast<std::int32_t>(rng.between(1, 5)), fill,
           static_cast<std::int32_t>(rng.between(1, 3))},
          corners);
  }
}

TEST_CASE("two corners make a wall, and a star has a hole by the even-odd rule", "[sculpt]") {
  const auto wall =
      polygon_build({3, SolidFill::solid, 1}, std::vector<VoxelPos>{{0, 7, 0}, {9, 0, 4}}, 1);
  REQUIRE(wall);
  CHECK(wall->build->touched() == 30);
  const std::vector<VoxelPos> star = {
      {0, 0, 40}, {24, 0, -32}, {-38, 0, 12}, {38, 0, 12}, {-24, 0, -32}};
  const auto made = polygon_build({1, SolidFill::solid, 1}, star, 1);
  REQUIRE(made);
  CHECK_FALSE(made->build->at({-made->at.x, 0, -made->at.z}));
  check({1, SolidFill::solid, 1}, star);
}

TEST_CASE("a polygon that is too long is refused", "[sculpt]") {
  const auto made = polygon_build({}, std::vector<VoxelPos>{{0, 0, 0}, {kSolidSideMax, 0, 3}}, 1);
  REQUIRE_FALSE(made);
  CHECK(made.error().code == ErrorCode::limit_exceeded);
  CHECK(polygon_build({}, std::vector<VoxelPos>{{0, 0, 0}, {kSolidSideMax - 1, 0, 3}}, 1));
}

}  // namespace runstone::test
