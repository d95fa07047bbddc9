#include "client/play/player.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace runstone;

namespace {
constexpr double kPi = std::numbers::pi;
}

TEST_CASE("a pose has yaw and pitch in the units of the protocol", "[client_app]") {
  Player player;
  player.move_to({1, 2, 3});
  player.look(kPi / 2, kPi / 4);
  CHECK(player.pose().at == WorldPos{1, 2, 3});
  CHECK(player.pose().yaw == 16384);
  CHECK(player.pose().pitch == 8192);
  CHECK(yaw_of(player.pose()) == Approx(kPi / 2));
  player.look(-kPi / 2, -kPi);  // yaw is wrapped, pitch limited to just less than straight down
  CHECK(player.pose().yaw == 49152);
  CHECK(player.pose().pitch > -16384);
  CHECK(player.pose().pitch < -16000);
}

TEST_CASE("forward moves in the direction of sight, and right moves to the right of it",
          "[client_app]") {
  Player player;
  WindowInput input;
  input.forward = true;
  player.fly(input, 1);
  CHECK(player.eye().z > 1);  // yaw 0 looks along +z
  CHECK(player.eye().x == Approx(0).margin(1e-9));
  player = Player();
  input = {};
  input.right = true;
  player.fly(input, 1);
  CHECK(player.eye().x < -1);  // in right-handed coordinates with y up, -x is to the right of +z
  player = Player();
  input = {};
  input.look_dx = 100;  // the mouse moves right
  player.turn(input);
  CHECK(player.direction().x < 0);
  input = {};
  input.look_dy = -100;  // and up
  player.turn(input);
  CHECK(player.direction().y > 0);
}

TEST_CASE("a player who walks is where the body's eye is, and flies on from there",
          "[client_app]") {
  // Stone below y = 0.
  class Ground final : public VoxelSpace {
   public:
    Ground() : VoxelSpace(16) {}
    const RunChunk* chunk(ChunkCoord at) const override { return at.y < 0 ? &stone_ : &empty_; }

   private:
    RunChunk stone_ = uniform_chunk(Extent::cube(16), 1);
    RunChunk empty_ = uniform_chunk(Extent::cube(16), kEmpty);
  };
  const Ground ground;
  const BodyMaterials materials = body_materials(default_material_table());
  Player player;
  player.move_to({0.5, 10, 0.5});
  player.set_walking(true);
  WindowInput input;
  for (int i = 0; i < 200; ++i) player.walk(input, 0.02, ground, materials);
  CHECK(player.eye().y == Approx(kEyeHeight).margin(1e-4));
  input.forward = true;
  for (int i = 0; i < 50; ++i) player.walk(input, 0.02, ground, materials);
  CHECK(player.eye().z > 4);
  player.set_walking(false);
  input.forward = false;
  input.up = true;
  player.fly(input, 1);
  CHECK(player.eye().y > 10);
  CHECK(player.eye().z > 4);
}

TEST_CASE("a player who falls out of the world is back at its spawn, and flies", "[client_app]") {
  class Void final : public VoxelSpace {
   public:
    Void() : VoxelSpace(16) {}
    const RunChunk* chunk(ChunkCoord) const override { return &empty_; }

   private:
    RunChunk empty_ = uniform_chunk(Extent::cube(16), kEmpty);
  };
  const Void space;
  const BodyMaterials materials = body_materials(default_material_table());
  Player player;
  player.enter(WorldId{1}, {10, 20, 30});
  player.set_walking(true);
  for (int i = 0; i < 100 && player.is_walking(); ++i) {
    CHECK_FALSE(player.take_fallen_out());
    player.walk({}, 0.2, space, materials);
  }
  CHECK_FALSE(player.is_walking());
  CHECK(player.eye() == WorldPos{10, 20, 30});
  CHECK(player.take_fallen_out());
  CHECK_FALSE(player.take_fallen_out());
}

TEST_CASE("the flying speed doubles and halves between its limits", "[client_app]") {
  Player player;
  const double usual = player.flying_speed();
  player.change_flying_speed(1);
  CHECK(player.flying_speed() == 2 * usual);
  WindowInput input;
  input.forward = true;
  player.fly(input, 1);
  CHECK(player.eye().z == Approx(2 * usual));
  player.change_flying_speed(100);
  CHECK(player.flying_speed() == 96);
  player.change_flying_speed(-100);
  CHECK(player.flying_speed() == 1.5);
}

TEST_CASE("the chunk of the eye is found by floor division", "[client_app]") {
  Player player;
  player.move_to({-0.5, 15.9, 16});
  CHECK(player.chunk(16) == ChunkCoord{-1, 0, 1});
  player.move_to({1e300, -1e300, NAN});
  CHECK(player.chunk(16) == ChunkCoord{(kWorldLimit - 1) / 16, -kWorldLimit / 16, 0});
}

TEST_CASE(
    "a player enters a world at its spawn, stays in place when it is back, "
    "and begins anew in another",
    "[client_app]") {
  Player player;
  const WorldId first{1}, second{2};
  player.enter(first, {10, 20, 30});
  CHECK(player.eye() == WorldPos{10, 20, 30});
  player.move_to({500, 60, 500});
  player.enter(first, {10, 20, 30});  // the server was restarted
  CHECK(player.eye() == WorldPos{500, 60, 500});
  player.enter(second, {-1, 2, -3});  // another world at the same address
  CHECK(player.eye() == WorldPos{-1, 2, -3});
  player.enter(first, {10, 20, 30});
  CHECK(player.eye() == WorldPos{10, 20, 30});
}

TEST_CASE("a player that flies is in the voxel of the eye, and one that walks in those of the body",
          "[client_app]") {
  Player player;
  player.move_to({0.5, 2.0 + kEyeHeight, 0.5});
  CHECK(player.is_in({0, 3, 0}));
  CHECK_FALSE(player.is_in({0, 2, 0}));
  player.set_walking(true);
  CHECK(player.is_in({0, 2, 0}));
  CHECK(player.is_in({0, 3, 0}));
  CHECK_FALSE(player.is_in({0, 1, 0}));  // the ground
  CHECK_FALSE(player.is_in({1, 2, 0}));
  player.move_to({0.9, 2.0 + kEyeHeight, 0.5});
  CHECK(player.is_in({1, 2, 0}));  // half of the body
}

TEST_CASE("a player enters a world at the place where the player left it", "[client_app]") {
  Player player;
  const Pose place{{5, 6, 7}, 16384, -8192};
  player.enter({1}, {1, 2, 3}, place);
  CHECK(player.eye() == place.at);
  CHECK(player.pose() == place);
  player.move_to({9, 9, 9});
  player.enter({1}, {1, 2, 3}, place);  // connected again
  CHECK(player.eye() == WorldPos{9, 9, 9});
  player.enter({2}, {1, 2, 3});
  CHECK(player.eye() == WorldPos{1, 2, 3});
}
