#include "client/replica/ray_pick.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "common/core/hash.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"

using namespace runstone;

namespace {

constexpr std::int32_t kRayEdge = 16;

/// 3 x 3 x 3 chunks around the origin with random single voxels.
void fill_world(Replica& replica, SplitMix64& rng) {
  runstone::test::AuthorityModel world(kRayEdge);
  for (ClientSequence i = 1; i <= 5000; ++i) {
    const auto at = [&] { return rng.between(-16, 31); };
    const VoxelPos pos{at(), at(), at()};
    static_cast<void>(
        world.commit({9, 1, i}, {SetVoxel{pos}, {}, static_cast<Material>(1 + rng.below(4))}));
  }
  replica.set_view({1, {0, 0, 0}, 2, 1});
  static_cast<void>(replica.open({kRayEdge, 1, 1, 1, 0, 0, 0}));
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        ChunkSnapshot snapshot = world.snapshot({x, y, z});
        // The base of the model is solid below 0. It is replaced by air, so that rays pass.
        if (y < 0) runstone::test::AuthorityModel::hollow(snapshot.chunk, 1);
        replica.receive(test::chunks_of(std::move(snapshot)), {});
      }
    }
  }
}

/// Returns the nearest solid voxel by testing the box of every voxel against the ray (slabs).
struct Brute {
  VoxelPos voxel;
  double distance;
};
std::optional<Brute> brute_pick(const Replica& replica, const WorldPos& eye,
                                const LookDirection& look, double reach) {
  std::optional<Brute> best;
  for (int x = -16; x < 32; ++x) {
    for (int y = -16; y < 32; ++y) {
      for (int z = -16; z < 32; ++z) {
        if (replica.shown_at({x, y, z}).value_or(kEmpty) == kEmpty) continue;
        double enter = 0, leave = reach;
        const double from[3] = {eye.x, eye.y, eye.z}, slope[3] = {look.x, look.y, look.z};
        const int low[3] = {x, y, z};
        for (int a = 0; a < 3; ++a) {
          double near = (low[a] - from[a]) / slope[a], far = (low[a] + 1 - from[a]) / slope[a];
          if (near > far) std::swap(near, far);
          enter = std::max(enter, near);
          leave = std::min(leave, far);
        }
        if (enter <= leave && (!best || enter < best->distance)) best = Brute{{x, y, z}, enter};
      }
    }
  }
  return best;
}

}  // namespace

TEST_CASE("a picked voxel is the nearest one that the ray meets", "[replica]") {
  SplitMix64 rng{Catch::rngSeed() + 5};
  Replica replica;
  fill_world(replica, rng);
  int hits = 0;
  for (int round = 0; round < 60; ++round) {
    const auto real = [&](double low, double high) {
      return low + (high - low) * rng.below(1 << 20) / (1 << 20);
    };
    const WorldPos eye{real(-4, 20), real(-4, 20), real(-4, 20)};
    const LookDirection look = look_direction(real(-3.1, 3.1), real(-1.5, 1.5));
    const double reach = 12;  // ends inside the loaded chunks
    const auto hit = pick(replica, ShapeTable{}, eye, look, reach);
    const auto expected = brute_pick(replica, eye, look, reach);
    CAPTURE(round, eye.x, eye.y, eye.z, look.x, look.y, look.z);
    REQUIRE(hit.has_value() == expected.has_value());
    if (!hit) continue;
    ++hits;
    CHECK(hit->voxel == expected->voxel);
    CHECK(hit->distance == Approx(expected->distance).margin(1e-9));
    CHECK(hit->material == *replica.shown_at(hit->voxel));
    if (!hit->face) continue;
    // The voxel at the face is the empty one through which the ray came.
    CHECK(replica.shown_at(*place_against(*hit)) == kEmpty);
  }
  CHECK(hits > 10);
}

TEST_CASE("a hit names the face through which the ray entered", "[replica]") {
  Replica replica;
  runstone::test::AuthorityModel world(kRayEdge);
  static_cast<void>(world.commit({9, 1, 1}, {SetVoxel{{5, 5, 5}}, {}, 3}));
  replica.set_view({1, {0, 0, 0}, 0, 0});
  static_cast<void>(replica.open({kRayEdge, 1, 1, 1, 0, 0, 0}));
  replica.receive(test::chunks_of(world.snapshot({0, 0, 0})), {});
  const double turn = 2 * std::numbers::pi;

  const auto along_z = pick(replica, ShapeTable{}, {5.5, 5.5, 1}, look_direction(0, 0), 10);
  REQUIRE(along_z);
  CHECK(along_z->voxel == VoxelPos{5, 5, 5});
  CHECK(along_z->face == Direction::neg_z);
  CHECK(along_z->distance == Approx(4));
  CHECK(place_against(*along_z) == VoxelPos{5, 5, 4});

  const auto along_x = pick(replica, ShapeTable{}, {1, 5.5, 5.5}, look_direction(turn / 4, 0), 10);
  REQUIRE(along_x);
  CHECK(along_x->face == Direction::neg_x);

  const auto down = pick(replica, ShapeTable{}, {5.5, 9.5, 5.5}, look_direction(0, -turn / 4), 10);
  REQUIRE(down);
  CHECK(down->face == Direction::pos_y);

  const auto inside = pick(replica, ShapeTable{}, {5.5, 5.5, 5.5}, look_direction(0, 0), 10);
  REQUIRE(inside);
  CHECK_FALSE(inside->face);
  CHECK_FALSE(place_against(*inside));

  CHECK_FALSE(
      pick(replica, ShapeTable{}, {5.5, 5.5, 1}, look_direction(0, 0), 3.9));  // out of reach
  CHECK_FALSE(pick(replica, ShapeTable{}, {5.5, 5.5, 1}, look_direction(turn / 2, 0),
                   100));  // leaves the shown chunks
  CHECK_FALSE(pick(replica, ShapeTable{}, {NAN, 5.5, 1}, look_direction(0, 0), 10));
  CHECK_FALSE(pick(Replica{}, ShapeTable{}, {5.5, 5.5, 1}, look_direction(0, 0), 10));
}

TEST_CASE("a ray goes through the materials that it passes", "[replica]") {
  Replica replica;
  runstone::test::AuthorityModel world(kRayEdge);
  static_cast<void>(world.commit({9, 1, 1}, {FillBox{{{3, 3, 3}, {9, 8, 9}}}, {}, 3}));
  static_cast<void>(world.commit({9, 1, 2}, {SetVoxel{{5, 5, 6}}, {}, 4}));
  replica.set_view({1, {0, 0, 0}, 0, 0});
  static_cast<void>(replica.open({kRayEdge, 1, 1, 1, 0, 0, 0}));
  replica.receive(test::chunks_of(world.snapshot({0, 0, 0})), {});
  const auto passes = [](Material material) { return material == 3; };
  const WorldPos outside{5.5, 5.5, 1}, inside{5.5, 5.5, 4.5};
  for (const WorldPos& eye : {outside, inside}) {
    const auto hit = pick(replica, ShapeTable{}, eye, look_direction(0, 0), 8, passes);
    REQUIRE(hit);
    CHECK(hit->voxel == VoxelPos{5, 5, 6});
    CHECK(hit->face == Direction::neg_z);
    CHECK(hit->distance == Approx(6 - eye.z));
  }
  CHECK(pick(replica, ShapeTable{}, outside, look_direction(0, 0), 8)->voxel == VoxelPos{5, 5, 3});
  CHECK_FALSE(pick(replica, ShapeTable{}, {5.5, 4.5, 1}, look_direction(0, 0), 8, passes));
}
