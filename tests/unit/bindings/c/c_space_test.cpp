#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/collision/merged_boxes.hpp"
#include "common/collision/sweep.hpp"
#include "common/core/hash.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/bindings/c/owned_handle.hpp"

namespace runstone::test {
namespace {

/// The chunk at the origin; all others are not known.
class LoneChunk final : public VoxelSpace {
 public:
  explicit LoneChunk(RunChunk chunk) : VoxelSpace(16), chunk_(std::move(chunk)) {}
  const RunChunk* chunk(ChunkCoord at) const override {
    return at == ChunkCoord{} ? &chunk_ : nullptr;
  }

 private:
  RunChunk chunk_;
};

Owned<runstone_space> space_of(const RunChunk& chunk) {
  auto space =
      owned<runstone_space>([](runstone_space** out) { return runstone_space_create(16, out); });
  REQUIRE(runstone_space_set(space.get(), {0, 0, 0}, handle_of(chunk).get()) == RUNSTONE_OK);
  return space;
}

}  // namespace

TEST_CASE("bodies move through the C interface as in the library", "[c_interface]") {
  SplitMix64 rng{51};
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const RunChunk chunk = random_chunk(rng, Extent::cube(16), random_order(rng), 3);
    const LoneChunk known(chunk);
    const auto space = space_of(chunk);
    const auto between = [&rng](int low, int high) {
      return static_cast<double>(rng.between(low * 8, high * 8)) / 8;
    };
    const WorldPos at{between(1, 14), between(1, 14), between(1, 14)};
    const BodyBox box{at, {at.x + 0.6, at.y + 1.8, at.z + 0.6}};
    const WorldPos move{between(-9, 9), between(-9, 9), between(-9, 9)};
    const runstone_body body{{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
    const runstone_vec by{move.x, move.y, move.z};

    runstone_sweep hit{};
    hit.struct_size = sizeof hit;
    REQUIRE(runstone_space_sweep(space.get(), body, by, &hit) == RUNSTONE_OK);
    const auto expected = sweep(known, MaterialSet{}, box, move);
    REQUIRE((hit.is_hit != 0) == expected.has_value());
    if (expected) {
      CHECK(hit.fraction == expected->fraction);
      CHECK(hit.direction == static_cast<std::uint32_t>(expected->face));
      CHECK(VoxelPos{hit.voxel.x, hit.voxel.y, hit.voxel.z} == expected->voxel);
    } else {
      CHECK(hit.fraction == 1);
      CHECK(hit.direction == RUNSTONE_DIRECTION_NONE);
    }
    runstone_slide end{};
    end.struct_size = sizeof end;
    REQUIRE(runstone_space_slide(space.get(), body, by, &end) == RUNSTONE_OK);
    const Slide slid = slide(known, MaterialSet{}, box, move);
    CHECK(WorldPos{end.moved.x, end.moved.y, end.moved.z} == slid.moved);
    for (std::size_t d = 0; d < kDirectionCount; ++d)
      CHECK((end.stopped >> d & 1) == (slid.is_stopped[d] ? 1U : 0U));
    std::uint32_t is_inside = 2;
    REQUIRE(runstone_space_overlaps(space.get(), body, &is_inside) == RUNSTONE_OK);
    CHECK((is_inside != 0) == overlaps(known, MaterialSet{}, box));
  }
}

TEST_CASE("a ray of the C interface passes what is not solid", "[c_interface]") {
  RunChunk chunk = uniform_chunk(Extent::cube(16), 0);
  fill(chunk, index_of({8, 4, 4}, chunk.extent, chunk.order), 1, 1);  // water
  fill(chunk, index_of({12, 4, 4}, chunk.extent, chunk.order), 1, 2);
  const auto space = space_of(chunk);
  const std::uint8_t solid[3] = {0, 0, 1};
  REQUIRE(runstone_space_set_solid(space.get(), solid, 3, 1) == RUNSTONE_OK);
  runstone_ray ray{};
  ray.struct_size = sizeof ray;
  ray.reserved = 7;
  // A direction may have any length.
  REQUIRE(runstone_space_pick(space.get(), {2.5, 4.5, 4.5}, {1e-200, 0, 0}, 100, &ray) ==
          RUNSTONE_OK);
  CHECK(ray.is_hit == 1);
  CHECK(ray.voxel.x == 12);
  CHECK(ray.material == 2);
  CHECK(ray.direction == RUNSTONE_NEG_X);
  CHECK(ray.distance == Approx(9.5));
  CHECK(ray.reserved == 0);
  REQUIRE(runstone_space_pick(space.get(), {2.5, 4.5, 4.5}, {1, 0, 0}, 9, &ray) == RUNSTONE_OK);
  CHECK(ray.is_hit == 0);
  CHECK(ray.direction == RUNSTONE_DIRECTION_NONE);
  // The chunk is forgotten.
  REQUIRE(runstone_space_set(space.get(), {0, 0, 0}, nullptr) == RUNSTONE_OK);
  REQUIRE(runstone_space_pick(space.get(), {2.5, 4.5, 4.5}, {1, 0, 0}, 100, &ray) == RUNSTONE_OK);
  CHECK(ray.is_hit == 0);
}

TEST_CASE("bodies, rays and chunks that a space cannot take are refused", "[c_interface]") {
  const auto space = space_of(uniform_chunk(Extent::cube(16), 0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  runstone_sweep hit{};
  hit.struct_size = sizeof hit;
  const auto swept = [&](runstone_body body, runstone_vec move) {
    return runstone_space_sweep(space.get(), body, move, &hit);
  };
  CHECK(swept({{0, 0, 0}, {1, 1, 1}}, {0, 0, 0}) == RUNSTONE_OK);
  CHECK(swept({{0, 0, 0}, {1, 0, 1}}, {0, 0, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{0, 1, 1}, {1e-17, 2, 2}}, {100, 5, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{0, 0, 0}, {1, 1, 1e-6}}, {0, 0, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{0, nan, 0}, {1, 1, 1}}, {0, 0, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{0, 0, 0}, {1, infinite, 1}}, {0, 0, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{0, 0, 0}, {257, 1, 1}}, {0, 0, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{0, 0, 0}, {1, 1, 1}}, {0, -257, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{0, 0, 0}, {1, 1, 1}}, {0, nan, 0}) == RUNSTONE_BAD_ARGUMENT);
  CHECK(swept({{1e9, 0, 0}, {1e9 + 1, 1, 1}}, {0, 0, 0}) == RUNSTONE_BAD_ARGUMENT);
  runstone_ray ray{};
  ray.struct_size = sizeof ray;
  const auto picked = [&](runstone_vec eye, runstone_vec look, double reach) {
    return runstone_space_pick(space.get(), eye, look, reach, &ray);
  };
  CHECK(picked({0, 0, 0}, {0, 0, 0}, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(picked({0, 0, 0}, {nan, 0, 1}, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(picked({0, 0, 0}, {infinite, 0, 1}, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(picked({0, 0, 0}, {1, 0, 1}, nan) == RUNSTONE_BAD_ARGUMENT);
  CHECK(picked({0, 0, 0}, {1, 0, 1}, 513) == RUNSTONE_BAD_ARGUMENT);
  CHECK(picked({nan, 0, 0}, {1, 0, 1}, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(picked({0, 0, infinite}, {1, 0, 1}, 1) == RUNSTONE_BAD_ARGUMENT);
  ray.struct_size = 0;
  CHECK(picked({0, 0, 0}, {1, 0, 1}, 1) == RUNSTONE_BAD_ARGUMENT);

  const auto other = handle_of(uniform_chunk(Extent::cube(32), 0));
  CHECK(runstone_space_set(space.get(), {0, 0, 0}, other.get()) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_space_set(space.get(), {1 << 25, 0, 0}, nullptr) == RUNSTONE_BAD_ARGUMENT);
  const std::uint8_t solid = 1;
  CHECK(runstone_space_set_solid(space.get(), &solid, 65537, 1) == RUNSTONE_BAD_ARGUMENT);
  // Material 0 is empty for rays and bodies.
  CHECK(runstone_space_set_solid(space.get(), &solid, 1, 1) == RUNSTONE_BAD_ARGUMENT);
}

TEST_CASE("boxes of the C interface are those of the library", "[c_interface]") {
  SplitMix64 rng{52};
  const std::uint8_t solid[3] = {0, 1, 0};
  for (int round = 0; round < 20; ++round) {
    const RunChunk chunk = random_chunk(rng, 24, 4);
    const auto handle = handle_of(chunk);
    const auto boxes =
        fetched<runstone_local_box>([&](auto* out, std::size_t room, std::size_t* n) {
          return runstone_chunk_boxes(handle.get(), solid, 3, 1, out, room, n);
        });
    std::vector<MergedBox> expected;
    REQUIRE(
        merge_boxes(chunk, {{false, true, false}, true}, kMergedBoxesMax, expected).has_value());
    REQUIRE(boxes.size() == expected.size());
    bool is_equal = true;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        is_equal = is_equal && boxes[i].min[axis] == expected[i].min[axis] &&
                   boxes[i].max[axis] == expected[i].max[axis];
    }
    CHECK(is_equal);
  }
}

}  // namespace runstone::test
