#include "common/core/coords.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"

using namespace runstone;

TEST_CASE("floor division rounds down on both sides of zero", "[core][coords]") {
  CHECK(floor_div(7, 4) == 1);
  CHECK(floor_div(8, 4) == 2);
  CHECK(floor_div(0, 4) == 0);
  CHECK(floor_div(-1, 4) == -1);
  CHECK(floor_div(-4, 4) == -1);
  CHECK(floor_div(-5, 4) == -2);
  CHECK(floor_div(-8, 4) == -2);
  CHECK(floor_div(-kWorldLimit, 128) == -(1 << 22));
  CHECK(floor_div(kWorldLimit - 1, 128) == (1 << 22) - 1);
}

TEST_CASE("floor division is the one quotient with a remainder from 0 up", "[core][coords]") {
  SplitMix64 rng(3);
  for (int i = 0; i < 10000; ++i) {
    const std::int32_t b = rng.between(1, 200);
    const std::int32_t a =
        rng.between(i % 2 == 0 ? -300 : -kWorldLimit, i % 2 == 0 ? 300 : kWorldLimit - 1);
    const std::int64_t rest = a - std::int64_t{floor_div(a, b)} * b;
    CAPTURE(a, b);
    REQUIRE(rest >= 0);
    REQUIRE(rest < b);
  }
}

TEST_CASE("every voxel lies in the box of its chunk, at its local position", "[core][coords]") {
  SplitMix64 rng(4);
  for (int i = 0; i < 4000; ++i) {
    const std::int32_t edge = 16 << rng.below(4);
    const auto coordinate = [&] {
      return rng.below(2) == 0 ? rng.between(-2 * edge - 1, 2 * edge + 1)
                               : rng.between(-kWorldLimit, kWorldLimit - 1);
    };
    const VoxelPos p{coordinate(), coordinate(), coordinate()};
    const ChunkCoord c = chunk_of(p, edge);
    const LocalPos local = local_of(p, edge);
    const VoxelPos o = origin_of(c, edge);
    CAPTURE(p.x, p.y, p.z, edge);
    REQUIRE(box_of(c, edge).contains(p));
    REQUIRE(VoxelPos{o.x + local.x, o.y + local.y, o.z + local.z} == p);
    REQUIRE(int{local.x} < edge);
    REQUIRE(int{local.y} < edge);
    REQUIRE(int{local.z} < edge);
  }
  CHECK(chunk_of({-1, 0, -32}, 32) == ChunkCoord{-1, 0, -1});
  CHECK(local_of({-1, 0, -32}, 32) == LocalPos{31, 0, 0});
}

TEST_CASE("boxes are half-open, and empty when a side is", "[core][coords]") {
  const VoxelBox box{{0, 0, 0}, {2, 3, 4}};
  CHECK(box.contains({0, 0, 0}));
  CHECK(box.contains({1, 2, 3}));
  CHECK_FALSE(box.contains({2, 0, 0}));
  CHECK_FALSE(box.contains({0, 3, 0}));
  CHECK_FALSE(box.contains({0, 0, -1}));
  CHECK_FALSE(box.empty());
  CHECK(VoxelBox{{0, 0, 0}, {2, 0, 4}}.empty());
  CHECK(VoxelBox{{5, 0, 0}, {2, 3, 4}}.empty());
}

TEST_CASE("an intersection holds the voxels that both boxes hold", "[core][coords]") {
  SplitMix64 rng(5);
  const auto random_box = [&] {
    VoxelBox b;
    b.min = {rng.between(-4, 3), rng.between(-4, 3), rng.between(-4, 3)};
    b.max = {rng.between(-4, 4), rng.between(-4, 4), rng.between(-4, 4)};
    return b;
  };
  for (int i = 0; i < 200; ++i) {
    const VoxelBox a = random_box();
    const VoxelBox b = random_box();
    const VoxelBox both = intersect(a, b);
    bool any = false;
    for (int x = -5; x < 5; ++x) {
      for (int y = -5; y < 5; ++y) {
        for (int z = -5; z < 5; ++z) {
          const bool inside = a.contains({x, y, z}) && b.contains({x, y, z});
          any = any || inside;
          REQUIRE(both.contains({x, y, z}) == inside);
        }
      }
    }
    REQUIRE(both.empty() == !any);
  }
}

TEST_CASE("the bounding box of two boxes is the smallest that holds both", "[core][coords]") {
  const VoxelBox a{{-5, 2, 0}, {1, 3, 4}}, b{{0, -7, 1}, {9, 0, 2}}, none{{1, 1, 1}, {1, 5, 5}};
  CHECK(bounding_box(a, b) == VoxelBox{{-5, -7, 0}, {9, 3, 4}});
  CHECK(bounding_box(b, a) == bounding_box(a, b));
  CHECK(bounding_box(a, none) == a);
  CHECK(bounding_box(none, a) == a);
}

TEST_CASE("directions name axis, sign, opposite and neighbour", "[core][coords]") {
  const ChunkCoord c{1, -2, 3};
  CHECK(neighbour(c, Direction::neg_x) == ChunkCoord{0, -2, 3});
  CHECK(neighbour(c, Direction::pos_x) == ChunkCoord{2, -2, 3});
  CHECK(neighbour(c, Direction::neg_y) == ChunkCoord{1, -3, 3});
  CHECK(neighbour(c, Direction::pos_y) == ChunkCoord{1, -1, 3});
  CHECK(neighbour(c, Direction::neg_z) == ChunkCoord{1, -2, 2});
  CHECK(neighbour(c, Direction::pos_z) == ChunkCoord{1, -2, 4});
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto d = static_cast<Direction>(i);
    CHECK(axis_of(opposite(d)) == axis_of(d));
    CHECK(is_positive(opposite(d)) != is_positive(d));
    CHECK(neighbour(neighbour(c, d), opposite(d)) == c);
  }
}
