#include "client/body/walker.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kStone = 1, kWater = 2;

/// Flat stone below y = 0 and nothing above, with the voxels that a test sets.
class Ground final : public VoxelSpace {
 public:
  Ground() : VoxelSpace(kEdge) {}
  void set(VoxelPos at, Material material) {
    const ChunkCoord coord = chunk_of(at, kEdge);
    RunChunk& chunk = chunks_.try_emplace(coord, *this->chunk(coord)).first->second;
    fill(chunk, index_of(local_of(at, kEdge), chunk.extent, chunk.order), 1, material);
  }
  void set_box(const VoxelBox& box, Material material) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) set({x, y, z}, material);
      }
    }
  }
  void forget_all() { knows_nothing_ = true; }
  const RunChunk* chunk(ChunkCoord at) const override {
    if (knows_nothing_) return nullptr;
    const auto found = chunks_.find(at);
    if (found != chunks_.end()) return &found->second;
    return at.y < 0 ? &stone_ : &empty_;
  }

 private:
  std::map<ChunkCoord, RunChunk> chunks_;
  RunChunk stone_ = uniform_chunk(Extent::cube(kEdge), kStone);
  RunChunk empty_ = uniform_chunk(Extent::cube(kEdge), kEmpty);
  bool knows_nothing_ = false;
};

const BodyMaterials& materials() {
  static const BodyMaterials all{MaterialSet({false, true, false}, true),
                                 MaterialSet({false, false, true}, false)};
  return all;
}

constexpr WalkInput kEast{1, 0, false, false, false};

void advance(Walker& walker, const Ground& ground, const WalkInput& input, double seconds) {
  for (double left = seconds; left > 0; left -= 0.02)
    walker.advance(ground, materials(), input, std::min(left, 0.02));
}

Walker standing_at(const Ground& ground, double x, double y, double z) {
  Walker walker;
  walker.place({x, y, z});
  advance(walker, ground, {}, 0.5);
  REQUIRE(walker.is_on_ground());
  return walker;
}

}  // namespace

TEST_CASE("materials are solid, liquid or passable as their table says", "[body]") {
  MaterialTable table;
  REQUIRE(table.add({"stone", {1, 2, 3, 255}, Visibility::opaque, std::nullopt}).has_value());
  REQUIRE(table.add({"mark", {0, 0, 0, 0}, Visibility::empty, std::nullopt}).has_value());
  REQUIRE(
      table
          .add(
              {"water", {1, 2, 3, 90}, Visibility::transparent, std::nullopt, MaterialBody::liquid})
          .has_value());
  REQUIRE(table
              .add({"fern",
                    {1, 2, 3, 90},
                    Visibility::transparent,
                    std::nullopt,
                    MaterialBody::passable})
              .has_value());
  REQUIRE(table.add({"glass", {1, 2, 3, 90}, Visibility::transparent, std::nullopt}).has_value());
  const BodyMaterials body = body_materials(table);
  const std::vector<bool> solid = {false, true, false, false, false, true, true};
  const std::vector<bool> liquid = {false, false, false, true, false, false, false};
  for (Material id = 0; id < solid.size(); ++id) {
    CAPTURE(id);
    CHECK(body.solid.contains(id) == solid[id]);
    CHECK(body.liquid.contains(id) == liquid[id]);
  }
}

TEST_CASE("a walker falls to the ground and walks at its speed", "[body]") {
  const Ground ground;
  Walker walker;
  walker.place({0.5, 5, 0.5});
  advance(walker, ground, {}, 2);
  CHECK(walker.is_on_ground());
  CHECK(std::abs(walker.feet().y) < kTouchDepth);
  CHECK(walker.eye().y == Approx(kEyeHeight).margin(1e-5));
  advance(walker, ground, kEast, 2);
  CHECK(walker.feet().x == Approx(0.5 + 2 * 4.5).margin(0.5));
  CHECK(walker.feet().z == 0.5);
  advance(walker, ground, {}, 1);
  const double stopped = walker.feet().x;
  advance(walker, ground, {}, 1);
  CHECK(walker.feet().x == Approx(stopped).margin(1e-3));
}

TEST_CASE("a jump reaches one voxel and not two", "[body]") {
  const Ground ground;
  Walker walker = standing_at(ground, 0.5, 0, 0.5);
  double highest = 0;
  for (int i = 0; i < 60; ++i) {
    walker.advance(ground, materials(), {0, 0, i == 0, false, false}, kWalkStepS);
    highest = std::max(highest, walker.feet().y);
  }
  CHECK(highest > 1.1);
  CHECK(highest < 1.4);
}

TEST_CASE("a walker steps onto one voxel and is stopped by two", "[body]") {
  Ground ground;
  ground.set_box({{4, 0, -2}, {6, 1, 4}}, kStone);
  ground.set_box({{6, 0, -2}, {8, 3, 4}}, kStone);
  Walker walker = standing_at(ground, 0.5, 0, 0.5);
  advance(walker, ground, kEast, 3);
  CHECK(walker.feet().x == Approx(6 - kBodyWidth / 2));
  CHECK(walker.feet().y == Approx(1));
  CHECK(walker.eye().y == Approx(1 + kEyeHeight).margin(0.01));
}

TEST_CASE("a walker does not step up where its head has no room", "[body]") {
  Ground ground;
  ground.set_box({{4, 0, -2}, {6, 1, 4}}, kStone);
  ground.set_box({{4, 2, -2}, {6, 3, 4}}, kStone);
  Walker walker = standing_at(ground, 0.5, 0, 0.5);
  advance(walker, ground, kEast, 3);
  CHECK(walker.feet().x == Approx(4 - kBodyWidth / 2));
  CHECK(std::abs(walker.feet().y) < kTouchDepth);
}

TEST_CASE("a careful walker stays on the edge", "[body]") {
  Ground ground;
  ground.set_box({{-3, 0, -3}, {4, 4, 4}}, kStone);
  Walker walker = standing_at(ground, 0.5, 4, 0.5);
  WalkInput careful = kEast;
  careful.down = true;
  advance(walker, ground, careful, 3);
  CHECK(walker.is_on_ground());
  CHECK(walker.feet().y == Approx(4));
  CHECK(walker.feet().x == Approx(4 + kBodyWidth / 2).margin(0.05));
  advance(walker, ground, kEast, 2);
  CHECK(walker.feet().y < 1);
}

TEST_CASE("in water a walker sinks slowly and rises to its surface", "[body]") {
  Ground ground;
  ground.set_box({{-4, -8, -4}, {5, 0, 5}}, kWater);
  Walker walker;
  walker.place({0.5, -3, 0.5});
  advance(walker, ground, {}, 1);
  CHECK(walker.is_in_liquid());
  CHECK(walker.feet().y < -3.5);
  CHECK(walker.feet().y > -5);
  advance(walker, ground, {0, 0, true, false, false}, 3);
  CHECK(walker.feet().y > -1);
  advance(walker, ground, {1, 0, true, false, false}, 4);
  CHECK(walker.feet().x > 6);  // out of the water, onto the ground
}

TEST_CASE("a walker steps down one voxel without falling, and its eye follows smoothly", "[body]") {
  Ground ground;
  ground.set_box({{-3, 0, -3}, {2, 2, 4}}, kStone);  // two voxels high, then one, then none
  ground.set_box({{2, 0, -3}, {4, 1, 4}}, kStone);
  Walker walker = standing_at(ground, 0.5, 2, 0.5);
  double eye_before = walker.eye().y, steepest = 0;
  for (int i = 0; i < 240; ++i) {
    walker.advance(ground, materials(), kEast, kWalkStepS);
    CHECK(walker.is_on_ground());
    steepest = std::max(steepest, eye_before - walker.eye().y);
    eye_before = walker.eye().y;
  }
  CHECK(std::abs(walker.feet().y) < kTouchDepth);
  CHECK(walker.eye().y == Approx(kEyeHeight).margin(0.01));
  CHECK(steepest < 0.12);  // of a voxel in a step of time
}

TEST_CASE("a walker falls from an edge that is higher than a step", "[body]") {
  Ground ground;
  ground.set_box({{-3, 0, -3}, {2, 2, 4}}, kStone);
  Walker walker = standing_at(ground, 0.5, 2, 0.5);
  bool has_fallen = false;
  for (int i = 0; i < 120; ++i) {
    walker.advance(ground, materials(), kEast, kWalkStepS);
    has_fallen = has_fallen || walker.fallen() > 1;
  }
  CHECK(has_fallen);
  CHECK(walker.is_on_ground());
  CHECK(walker.fallen() == 0);
}

TEST_CASE("a walker wades in water of one voxel and jumps there", "[body]") {
  Ground ground;
  ground.set_box({{-4, 0, -4}, {20, 1, 5}}, kWater);
  Walker walker = standing_at(ground, 0.5, 0, 0.5);
  advance(walker, ground, kEast, 2);
  CHECK(walker.is_in_liquid());
  CHECK(walker.is_on_ground());
  CHECK(walker.feet().x > 0.5 + 2 * 3);
  CHECK(walker.feet().x < 0.5 + 2 * 4.5 - 0.5);  // slower than on land
  double highest = 0;
  for (int i = 0; i < 60; ++i) {
    walker.advance(ground, materials(), {0, 0, true, false, false}, kWalkStepS);
    highest = std::max(highest, walker.feet().y);
  }
  CHECK(highest > 1.1);
}

TEST_CASE("a swimmer floats at the surface and climbs onto a bank above it", "[body]") {
  Ground ground;
  ground.set_box({{-4, -8, -4}, {5, 0, 5}}, kWater);
  ground.set_box({{5, 0, -4}, {40, 1, 5}}, kStone);  // the bank, one voxel above the water
  Walker walker;
  walker.place({0.5, -3, 0.5});
  constexpr WalkInput kUp{0, 0, true, false, false};
  advance(walker, ground, kUp, 3);
  double lowest = walker.feet().y, highest = lowest;
  for (int i = 0; i < 240; ++i) {
    walker.advance(ground, materials(), kUp, kWalkStepS);
    lowest = std::min(lowest, walker.feet().y);
    highest = std::max(highest, walker.feet().y);
  }
  CHECK(highest - lowest < 0.05);  // it does not bob
  CHECK(highest < -0.3);           // the body is in the water
  CHECK(walker.eye().y > 0.2);     // and the eye above it
  advance(walker, ground, {1, 0, true, false, false}, 4);
  advance(walker, ground, {}, 1);
  CHECK(walker.feet().x > 5);
  CHECK(walker.feet().y == Approx(1));
}

TEST_CASE("a body that begins deep in the ground is put above it at once", "[body]") {
  const Ground ground;
  Walker walker;
  walker.place({0.5, -40.25, 0.5});
  advance(walker, ground, {}, 0.1);
  CHECK(std::abs(walker.feet().y) < 0.2);
  CHECK_FALSE(walker.is_waiting());
}

TEST_CASE("a body that is built into rises, and one in an unknown place rests", "[body]") {
  Ground ground;
  Walker walker = standing_at(ground, 0.5, 0, 0.5);
  ground.set_box({{0, 0, 0}, {1, 3, 1}}, kStone);
  advance(walker, ground, {}, 3);
  CHECK(walker.feet().y == Approx(3));
  CHECK_FALSE(walker.is_waiting());
  ground.forget_all();
  advance(walker, ground, kEast, 1);
  CHECK(walker.is_waiting());
  CHECK(walker.feet().x == 0.5);
  CHECK(walker.feet().y == Approx(3));
}

TEST_CASE("the way of a walker does not depend on the frame rate", "[body]") {
  Ground ground;
  ground.set_box({{3, 0, -9}, {4, 1, 9}}, kStone);
  Walker fast = standing_at(ground, 0.5, 0, 0.5), slow = fast;
  for (int i = 0; i < 240; ++i) fast.advance(ground, materials(), kEast, 1.0 / 240);
  for (int i = 0; i < 20; ++i) slow.advance(ground, materials(), kEast, 1.0 / 20);
  CHECK(fast.feet().x == Approx(slow.feet().x).margin(0.05));
  CHECK(fast.feet().y == Approx(slow.feet().y).margin(0.1));
}

TEST_CASE("no input leads a walker into a solid voxel", "[body][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int world = 0; world < 20; ++world) {
    Ground ground;
    for (int i = 0; i < 60; ++i) {
      const VoxelPos at{rng.between(-8, 8), rng.between(0, 6), rng.between(-8, 8)};
      const VoxelPos end{at.x + rng.between(1, 5), at.y + rng.between(1, 3),
                         at.z + rng.between(1, 5)};
      ground.set_box({at, end}, rng.below(4) == 0 ? kWater : kStone);
    }
    Walker walker;
    walker.place({0.5, 12, 0.5});
    for (int i = 0; i < 200; ++i) {
      const double angle = rng.below(628) / 100.0;
      const WalkInput input{std::cos(angle), std::sin(angle), rng.below(3) == 0, rng.below(4) == 0,
                            rng.below(2) == 0};
      advance(walker, ground, input, rng.below(40) / 100.0);
      CAPTURE(Catch::rngSeed(), world, i);
      REQUIRE_FALSE(overlaps(ground, materials().solid, body_at(walker.feet())));
    }
  }
}

TEST_CASE("a walker goes up a staircase of shapes by half steps, and under a slab", "[body]") {
  // Stairs that rise to the east, each a lower half and the eastern half above it.
  constexpr Material kStairs = 3, kTopSlab = 4;
  const std::vector<Shape> by_material = {
      {},
      {},
      {},
      {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}, {{8, 8, 0}, {16, 16, 16}}}},
      {ShapeForm::boxes, {{{0, 8, 0}, {16, 16, 16}}}}};
  const BodyMaterials with_shapes{Obstacles(MaterialSet({false, true, false, false, false}, true),
                                            MaterialSet({false, false, false, true, true}, false),
                                            std::make_shared<const ShapeTable>(by_material)),
                                  MaterialSet({false, false, true, false, false}, false)};
  Ground ground;
  for (std::int32_t i = 0; i < 4; ++i) {
    ground.set_box({{3 + i, 0, -2}, {4 + i, i, 3}}, kStone);
    ground.set_box({{3 + i, i, -2}, {4 + i, i + 1, 3}}, kStairs);
  }
  ground.set_box({{7, 0, -2}, {40, 4, 3}}, kStone);
  ground.set_box({{9, 5, -2}, {40, 6, 3}}, kTopSlab);  // 1.5 voxels of room: too low
  Walker walker;
  walker.place({1, 0, 0.5});
  double highest_step = 0;
  for (int i = 0; i < 400; ++i) {
    const double before = walker.feet().y;
    walker.advance(ground, with_shapes, kEast, 0.02);
    if (walker.is_on_ground()) highest_step = std::max(highest_step, walker.feet().y - before);
  }
  CHECK(walker.feet().y == Approx(4));
  CHECK(walker.feet().x == Approx(9 - kBodyWidth / 2));
  CHECK(highest_step == Approx(0.5).margin(0.01));
}

}  // namespace runstone::test
