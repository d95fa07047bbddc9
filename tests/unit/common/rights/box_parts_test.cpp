#include "common/rights/box_parts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

/// Returns in how many parts the voxel lies.
std::ptrdiff_t parts_at(const std::vector<VoxelBox>& parts, VoxelPos p) {
  return std::count_if(parts.begin(), parts.end(),
                       [p](const VoxelBox& part) { return part.contains(p); });
}

}  // namespace

TEST_CASE("a box without a hole is at most six parts that do not overlap", "[rights]") {
  const VoxelBox whole = {{0, 0, 0}, {4, 4, 4}};
  for (const VoxelBox& hole : {VoxelBox{{1, 1, 1}, {3, 3, 3}}, VoxelBox{{0, 0, 0}, {1, 1, 1}},
                               VoxelBox{{-5, 1, 2}, {9, 2, 3}}, VoxelBox{{3, 3, 3}, {9, 9, 9}},
                               VoxelBox{{-1, -1, -1}, {5, 5, 5}}, VoxelBox{{4, 0, 0}, {5, 4, 4}}}) {
    std::vector<VoxelBox> parts = {whole};
    REQUIRE(cut_out(parts, hole, 6));
    for (std::int32_t z = -1; z < 5; ++z) {
      for (std::int32_t y = -1; y < 5; ++y) {
        for (std::int32_t x = -1; x < 5; ++x) {
          const VoxelPos p = {x, y, z};
          CHECK(parts_at(parts, p) == (whole.contains(p) && !hole.contains(p) ? 1 : 0));
        }
      }
    }
  }
}

TEST_CASE("cutting stops at the largest number of parts", "[rights]") {
  std::vector<VoxelBox> parts = {{{0, 0, 0}, {4, 4, 4}}};
  CHECK_FALSE(cut_out(parts, {{1, 1, 1}, {3, 3, 3}}, 5));
}

}  // namespace runstone::test
