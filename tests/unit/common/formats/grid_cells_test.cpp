#include "common/formats/grid_cells.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

/// Returns all cells in the order of the axes, found one by one.
std::vector<std::uint16_t> cells_one_by_one(const Build& build, AxisOrder order) {
  const auto axes = axes_of(order);
  const VoxelPos sides = build.sides();
  const std::array<std::int32_t, 3> side = {sides.x, sides.y, sides.z};
  const auto side_of = [&](std::size_t i) { return side[static_cast<std::size_t>(axes[i])]; };
  std::vector<std::uint16_t> out;
  std::array<std::int32_t, 3> at{};
  const auto along = [&](std::size_t i) -> std::int32_t& {
    return at[static_cast<std::size_t>(axes[i])];
  };
  for (along(2) = 0; along(2) < side_of(2); ++along(2)) {
    for (along(1) = 0; along(1) < side_of(1); ++along(1)) {
      for (along(0) = 0; along(0) < side_of(0); ++along(0)) {
        const auto material = build.at({at[0], at[1], at[2]});
        out.push_back(material ? *build.number_of(*material) : std::uint16_t{0});
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("the walk over a build gives every cell, in each order of the axes", "[formats]") {
  SplitMix64 rng{5};
  for (const VoxelPos sides :
       {VoxelPos{1, 1, 1}, VoxelPos{130, 17, 20}, VoxelPos{9, 140, 18}, VoxelPos{17, 16, 150}}) {
    CAPTURE(sides.x);
    const FileBuild build = random_file_build(rng, sides, 5, true);
    for (const AxisOrder order : kAxisOrders) {
      CAPTURE(static_cast<int>(order));
      std::vector<std::uint16_t> cells;
      std::size_t joinable = 0;
      const auto walked =
          walk_cells(*build.build, order, [&](std::uint32_t count, std::uint16_t number) {
            if (!cells.empty() && cells.back() == number) ++joinable;
            cells.insert(cells.end(), count, number);
            return Result<void>{};
          });
      REQUIRE(walked);
      CHECK(joinable == 0);
      CHECK(cells == cells_one_by_one(*build.build, order));
    }
    const std::vector<std::uint64_t> counts = count_cells(*build.build);
    for (std::size_t number = 0; number < counts.size(); ++number) {
      const auto cells = cells_one_by_one(*build.build, AxisOrder::xyz);
      CHECK(counts[number] == static_cast<std::uint64_t>(std::count(
                                  cells.begin(), cells.end(), static_cast<std::uint16_t>(number))));
    }
  }
}

TEST_CASE("the walk over a build gives long stretches in parts, and ends at a failure",
          "[formats]") {
  const FileBuild build = file_build({300, 200, 3}, {file_material("a", "", {1, 2, 3, 255})},
                                     [](VoxelPos) { return std::uint16_t{1}; });
  std::uint64_t cells = 0, calls = 0;
  const auto whole = walk_cells(*build.build, AxisOrder::zyx,
                                [&](std::uint32_t count, std::uint16_t) -> Result<void> {
                                  CHECK(count < 65'536 + 128);
                                  cells += count;
                                  ++calls;
                                  return {};
                                });
  REQUIRE(whole);
  CHECK(cells == 180'000);
  CHECK(calls == 3);
  calls = 0;
  const auto ended =
      walk_cells(*build.build, AxisOrder::zyx, [&](std::uint32_t, std::uint16_t) -> Result<void> {
        if (++calls < 2) return {};
        return fail(ErrorCode::io_failed, "the disk is full");
      });
  REQUIRE_FALSE(ended);
  CHECK(ended.error().code == ErrorCode::io_failed);
  CHECK(calls == 2);
}

}  // namespace runstone::test
