// The walk through a VoxelSpace. tests/unit/client/replica/ray_pick_test.cpp has the cases of shapes
// and of materials that let a ray pass.
#include "common/collision/ray_walk.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace runstone::test {
namespace {

constexpr Material kPane = 7;

/// A single voxel in a known chunk at the origin; nothing else is known.
class OneKnownChunk final : public VoxelSpace {
 public:
  OneKnownChunk() : VoxelSpace(16) {
    fill(chunk_, index_of({5, 6, 7}, chunk_.extent, chunk_.order), 1, kPane);
  }
  const RunChunk* chunk(ChunkCoord at) const override {
    return at == ChunkCoord{} ? &chunk_ : nullptr;
  }

 private:
  RunChunk chunk_ = uniform_chunk(Extent::cube(16), kEmpty);
};

}  // namespace

TEST_CASE("a ray through a space meets the voxel in its way", "[collision]") {
  const OneKnownChunk space;
  const auto hit = first_hit(space, {}, {5.5, 6.5, 1.0}, {0, 0, 1}, 20);
  REQUIRE(hit.has_value());
  CHECK(hit->voxel == VoxelPos{5, 6, 7});
  CHECK(hit->material == kPane);
  CHECK(hit->face == Direction::neg_z);
  CHECK(hit->distance == Approx(6));
  // Too short, beside it, and from inside it.
  CHECK_FALSE(first_hit(space, {}, {5.5, 6.5, 1.0}, {0, 0, 1}, 5.9).has_value());
  CHECK_FALSE(first_hit(space, {}, {4.5, 6.5, 1.0}, {0, 0, 1}, 20).has_value());
  const auto inside = first_hit(space, {}, {5.5, 6.5, 7.5}, {0, 0, 1}, 20);
  REQUIRE(inside.has_value());
  CHECK_FALSE(inside->face.has_value());
}

TEST_CASE("a ray ends where the space is not known", "[collision]") {
  const OneKnownChunk space;
  CHECK_FALSE(first_hit(space, {}, {5.5, 6.5, -0.5}, {0, 0, 1}, 20).has_value());
  CHECK(first_hit(space, {}, {5.5, 6.5, 0.5}, {0, 0, 1}, 20).has_value());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(first_hit(space, {}, {nan, 6.5, 0.5}, {0, 0, 1}, 20).has_value());
}

}  // namespace runstone::test
