#include "common/core/coords_text.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a position is three coordinates of the world with commas", "[core]") {
  CHECK(parse_voxel_pos("1,-2,3") == VoxelPos{1, -2, 3});
  CHECK(parse_voxel_pos("-536870912,0,536870911") == VoxelPos{-kWorldLimit, 0, kWorldLimit - 1});
  for (const char* text : {"", "1,2", "1,2,", "1,2,3,", "1,2,3,4", "1, 2,3", "1;2;3", "a,2,3",
                           "1,2,3x", "536870912,0,0", "0,-536870913,0", "0,0,99999999999"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_voxel_pos(text));
  }
}

TEST_CASE("a box is two opposite corners, both inside, in any order", "[core]") {
  CHECK(parse_voxel_box("0,0,0,0,0,0") == VoxelBox{{0, 0, 0}, {1, 1, 1}});
  CHECK(parse_voxel_box("5,-2,9,1,7,-3") == VoxelBox{{1, -2, -3}, {6, 8, 10}});
  for (const char* text : {"", "1,2,3", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,536870912"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_voxel_box(text));
  }
}
