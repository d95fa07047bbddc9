#include "common/collision/sweep.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kStone = 5;

/// One chunk at the origin with the voxels that a test sets. All others are empty.
class Room final : public VoxelSpace {
 public:
  Room() : VoxelSpace(kEdge) {}
  void set(LocalPos at) { fill(chunk_, index_of(at, chunk_.extent, chunk_.order), 1, kStone); }
  void set_floor(std::uint8_t y) {
    for (std::uint8_t x = 0; x < kEdge; ++x) {
      for (std::uint8_t z = 0; z < kEdge; ++z) set({x, y, z});
    }
  }
  const RunChunk* chunk(ChunkCoord at) const override {
    return at == ChunkCoord{} ? &chunk_ : &empty_;
  }

 private:
  RunChunk chunk_ = uniform_chunk(Extent::cube(kEdge), kEmpty, AxisOrder::zxy);
  RunChunk empty_ = uniform_chunk(Extent::cube(kEdge), kEmpty);
};

/// A world of which nothing is loaded.
class Unknown final : public VoxelSpace {
 public:
  Unknown() : VoxelSpace(kEdge) {}
  const RunChunk* chunk(ChunkCoord /*at*/) const override { return nullptr; }
};

BodyBox body_at(double x, double y, double z) {
  return {{x - 0.3, y, z - 0.3}, {x + 0.3, y + 1.8, z + 0.3}};
}

}  // namespace

TEST_CASE("a body falls onto the floor and stands there", "[collision]") {
  Room room;
  room.set_floor(3);
  const auto hit = sweep(room, {}, body_at(8.5, 8, 8.5), {0, -8, 0});
  REQUIRE(hit.has_value());
  CHECK(hit->fraction == Approx(0.5));
  CHECK(hit->face == Direction::pos_y);
  CHECK(hit->voxel.y == 3);
  const Slide end = slide(room, {}, body_at(8.5, 4, 8.5), {2, -1, 0});
  CHECK(end.moved == WorldPos{2, 0, 0});
  CHECK(end.is_stopped[static_cast<std::size_t>(Direction::neg_y)]);
  CHECK_FALSE(end.is_stopped[static_cast<std::size_t>(Direction::pos_x)]);
}

TEST_CASE("a body that moves along a wall is not held by it", "[collision]") {
  Room room;
  for (std::uint8_t y = 0; y < kEdge; ++y) {
    for (std::uint8_t z = 0; z < kEdge; ++z) room.set({10, y, z});
  }
  const BodyBox beside{{9.4, 4, 4.2}, {10, 5.8, 4.8}};
  CHECK_FALSE(sweep(room, {}, beside, {0, 0, 6}).has_value());
  const Slide end = slide(room, {}, beside, {1, 0, 6});
  CHECK(end.moved.x == 0);
  CHECK(end.moved.z == Approx(6));
}

TEST_CASE("a body that meets a corner exactly does not pass through the voxel", "[collision]") {
  Room room;
  room.set({8, 8, 8});
  const BodyBox body{{6, 6, 6}, {7, 7, 7}};
  const auto hit = sweep(room, {}, body, {2, 2, 2});
  REQUIRE(hit.has_value());
  CHECK(hit->fraction == Approx(0.5));
  // Along an edge of the voxel it only touches.
  CHECK_FALSE(sweep(room, {}, {{6, 6, 7}, {7, 7, 8}}, {2, 2, 0}).has_value());
}

TEST_CASE("no body falls through a place where nothing is loaded", "[collision]") {
  const Unknown world;
  const auto hit = sweep(world, {}, body_at(0.5, 4.5, 0.5), {0, -9, 0});
  REQUIRE(hit.has_value());
  CHECK(hit->fraction * 9 == Approx(0.5));
  CHECK(overlaps(world, MaterialSet{}, body_at(0.5, 4.5, 0.5)));
}

TEST_CASE("a body inside a voxel can leave it", "[collision]") {
  Room room;
  room.set({4, 4, 4});
  const BodyBox inside{{4.2, 4.2, 4.2}, {4.8, 4.8, 4.8}};
  CHECK(overlaps(room, MaterialSet{}, inside));
  CHECK_FALSE(sweep(room, {}, inside, {3, 0, 0}).has_value());
}

TEST_CASE("a body at the border of the world does not sink by rounding", "[collision]") {
  // 2^28: the step of a position is 2^-24 there.
  class Floor final : public VoxelSpace {
   public:
    Floor() : VoxelSpace(kEdge) {}
    const RunChunk* chunk(ChunkCoord at) const override { return at.y < 0 ? &stone_ : &empty_; }

   private:
    RunChunk stone_ = uniform_chunk(Extent::cube(kEdge), kStone);
    RunChunk empty_ = uniform_chunk(Extent::cube(kEdge), kEmpty);
  };
  const Floor world;
  const double far = 1 << 28;
  double x = far + 0.1, y = 3;
  for (int step = 0; step < 10'000; ++step) {
    const Slide end = slide(world, {}, body_at(x, y, -far), {0.013, -0.07, 0});
    x += end.moved.x;
    y += end.moved.y;
  }
  CHECK(std::abs(y) < kTouchDepth);
  CHECK(x - far == Approx(130.1).margin(0.01));
}

TEST_CASE("a body and a move from data are checked before a sweep", "[collision]") {
  const BodyBox body{{1, 2, 3}, {2, 4, 4}};
  CHECK(validate_move(body, {256, -256, 0}).has_value());
  const double none = std::numeric_limits<double>::quiet_NaN(),
               endless = std::numeric_limits<double>::infinity();
  for (const double bad : {256.5, -300.0, none, endless})
    CHECK_FALSE(validate_move(body, {0, bad, 0}).has_value());
  for (const double bad : {2.0, 5.0, none, endless, -endless, -1e9})
    CHECK_FALSE(validate_move({{bad, 2, 3}, {2, 4, 4}}, {}).has_value());
  CHECK_FALSE(
      validate_move({{kWorldLimit - 2.0, 0, 0}, {kWorldLimit - 1.0, 1, 1}}, {2, 0, 0}).has_value());
}

}  // namespace runstone::test
