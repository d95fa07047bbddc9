#include "common/sculpt/solid.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

namespace runstone::test {
namespace {

/// The rule of the header, tested at one voxel: `at` and `sides` along the axis are y.
bool lies_in(SolidKind kind, VoxelPos at, VoxelPos sides) {
  if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= sides.x || at.y >= sides.y || at.z >= sides.z)
    return false;
  const double u = (2.0 * at.x + 1 - sides.x) / sides.x, v = (2.0 * at.y + 1 - sides.y) / sides.y,
               w = (2.0 * at.z + 1 - sides.z) / sides.z, up = (at.y + 0.5) / sides.y;
  constexpr double kRound = 1e-9;
  switch (kind) {
    case SolidKind::ellipsoid:
      return u * u + v * v + w * w <= 1 + kRound;
    case SolidKind::dome:
      return u * u + up * up + w * w <= 1 + kRound;
    case SolidKind::cylinder:
      return u * u + w * w <= 1 + kRound;
    case SolidKind::cone:
      return u * u + w * w <= (1 - up) * (1 - up) + kRound;
    case SolidKind::pyramid:
      return std::max(std::abs(u), std::abs(w)) <= 1 - up + kRound;
    case SolidKind::torus: {
      const double tube = std::min(0.5, double(sides.y) / std::min(sides.x, sides.z));
      const double off = (std::sqrt(u * u + w * w) - (1 - tube)) / tube;
      return off * off + v * v <= 1 + kRound;
    }
  }
  return false;
}

bool belongs(const Solid& solid, VoxelPos at, VoxelPos sides) {
  if (!lies_in(solid.kind, at, sides)) return false;
  if (solid.fill == SolidFill::solid) return true;
  const std::int32_t n = solid.wall;
  const bool is_open_above = solid.fill == SolidFill::walls && solid.kind != SolidKind::torus;
  const bool is_open_below = is_open_above || solid.kind == SolidKind::dome;
  const std::int32_t below = is_open_below ? 0 : n, above = is_open_above ? 0 : n;
  return !lies_in(solid.kind, {at.x - n, at.y - below, at.z - n},
                  {sides.x - 2 * n, sides.y - below - above, sides.z - 2 * n});
}

}  // namespace

TEST_CASE("solids equal the rule for each voxel", "[sculpt]") {
  const auto kind = static_cast<SolidKind>(GENERATE(range(0, kSolidKindCount)));
  const auto fill = static_cast<SolidFill>(GENERATE(range(0, kSolidFillCount)));
  const auto axis = static_cast<Axis>(GENERATE(0, 1, 2));
  const VoxelPos sides = GENERATE(VoxelPos{9, 7, 12}, VoxelPos{70, 7, 66}, VoxelPos{3, 3, 3});
  const std::int32_t wall = GENERATE(1, 3);
  CAPTURE(static_cast<int>(kind), static_cast<int>(fill), static_cast<int>(axis), sides.x, wall);
  const Solid solid{kind, fill, wall, axis};
  const auto build = solid_build(solid, sides, 5);
  std::uint64_t count = 0, wrong = 0;
  for (std::int32_t z = 0; z < sides.z; ++z) {
    for (std::int32_t y = 0; y < sides.y; ++y) {
      for (std::int32_t x = 0; x < sides.x; ++x) {
        std::array<std::int32_t, 3> at{x, y, z}, box{sides.x, sides.y, sides.z};
        std::swap(at[1], at[static_cast<std::size_t>(axis)]);
        std::swap(box[1], box[static_cast<std::size_t>(axis)]);
        const bool expected = belongs(solid, {at[0], at[1], at[2]}, {box[0], box[1], box[2]});
        count += expected ? 1U : 0U;
        if (!build) continue;
        const auto cell = (*build)->at({x, y, z});
        if (cell.has_value() != expected || (cell && *cell != 5)) ++wrong;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK((build ? (*build)->touched() : 0) == count);
  if (!build) CHECK(build.error().code == ErrorCode::bad_value);
}

TEST_CASE("a ring that is not solid has its inner and its outer wall", "[sculpt]") {
  const auto fill = GENERATE(SolidFill::hollow, SolidFill::walls);
  const auto ring = solid_build({SolidKind::torus, fill, 1, Axis::y}, {70, 20, 70}, 1);
  REQUIRE(ring);
  // The tube is 20 voxels wide. Along the middle it begins at x = 0 and ends at x = 19.
  CHECK((*ring)->at({0, 10, 35}).has_value());
  CHECK_FALSE((*ring)->at({10, 10, 35}).has_value());
  CHECK((*ring)->at({19, 10, 35}).has_value());
}

TEST_CASE("a solid that is too long is refused", "[sculpt]") {
  const auto build = solid_build({}, {kSolidSideMax + 1, 4, 4}, 1);
  REQUIRE_FALSE(build);
  CHECK(build.error().code == ErrorCode::limit_exceeded);
  CHECK(solid_build({}, {kSolidSideMax, 4, 4}, 1));
}

}  // namespace runstone::test
