#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include "common/collision/sweep.hpp"
#include "common/core/hash.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kShapeEdge = 16;
constexpr Material kShapeStone = 1, kSlab = 2, kOdd = 3;

const ShapeTable& shapes() {
  static const std::vector<Shape> by_material = {
      {},
      {},
      {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}},
      {ShapeForm::boxes, {{{0, 0, 0}, {5, 16, 7}}, {{3, 2, 4}, {16, 9, 16}}}}};
  static const ShapeTable table(by_material);
  return table;
}

const Obstacles& obstacles() {
  static const Obstacles all(MaterialSet({false, true, false, false}, true),
                             MaterialSet({false, false, true, true}, false),
                             std::make_shared<const ShapeTable>(shapes()));
  return all;
}

/// Chunks of a small world in which a test sets voxels.
class ShapeRoom final : public VoxelSpace {
 public:
  ShapeRoom() : VoxelSpace(kShapeEdge) {}
  void set(LocalPos at, Material material) {
    fill(chunk_, index_of(at, chunk_.extent, chunk_.order), 1, material);
  }
  const RunChunk* chunk(ChunkCoord at) const override {
    return at == ChunkCoord{} ? &chunk_ : &empty_;
  }

 private:
  RunChunk chunk_ = uniform_chunk(Extent::cube(kShapeEdge), kEmpty, AxisOrder::yzx);
  RunChunk empty_ = uniform_chunk(Extent::cube(kShapeEdge), kEmpty);
};

/// Places of the ends of a box by axis.
struct Ends {
  std::array<double, 3> min{}, max{};
};

/// The greatest depth, on its shallowest axis, to which two boxes overlap; below 0 if they do not.
double depth_of(const Ends& a, const Ends& b) {
  double out = 1e9;
  for (std::size_t i = 0; i < 3; ++i)
    out = std::min({out, a.max[i] - b.min[i], b.max[i] - a.min[i]});
  return out;
}

Ends moved(const BodyBox& body, const WorldPos& by, double fraction) {
  const double x = by.x * fraction, y = by.y * fraction, z = by.z * fraction;
  return {{body.min.x + x, body.min.y + y, body.min.z + z},
          {body.max.x + x, body.max.y + y, body.max.z + z}};
}

}  // namespace

TEST_CASE("a body falls onto a slab and slides along its upper face", "[collision]") {
  ShapeRoom room;
  for (std::uint8_t x = 0; x < kShapeEdge; ++x) room.set({x, 3, 8}, kSlab);
  const BodyBox body{{2, 5, 8.2}, {2.6, 6.8, 8.8}};
  const auto hit = sweep(room, obstacles(), body, {0, -3, 0});
  REQUIRE(hit.has_value());
  CHECK(hit->fraction == Approx(0.5));
  CHECK(hit->face == Direction::pos_y);
  CHECK(hit->voxel == VoxelPos{2, 3, 8});
  const Slide end = slide(room, obstacles(), {{2, 3.5, 8.2}, {2.6, 5.3, 8.8}}, {4, -1, 0});
  CHECK(end.moved.x == Approx(4));
  CHECK(end.moved.y == Approx(0).margin(1e-9));
  CHECK(overlaps(room, obstacles(), {{2, 3.4, 8.2}, {2.6, 5, 8.8}}));
  CHECK_FALSE(overlaps(room, obstacles(), {{2, 3.5, 8.2}, {2.6, 5, 8.8}}));
}

TEST_CASE("a body stops before the first cube or box on its way, and nowhere else", "[collision]") {
  SplitMix64 rng{Catch::rngSeed() + 9};
  const auto real = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng.below(1 << 20)) / (1 << 20);
  };
  int hits = 0, free = 0;
  for (int round = 0; round < 400; ++round) {
    ShapeRoom room;
    std::vector<Ends> solid;
    std::set<std::array<int, 3>> set;
    for (int i = 0; i < 40; ++i) {
      const LocalPos at{static_cast<std::uint8_t>(rng.below(kShapeEdge)),
                        static_cast<std::uint8_t>(rng.below(kShapeEdge)),
                        static_cast<std::uint8_t>(rng.below(kShapeEdge))};
      if (!set.insert({at.x, at.y, at.z}).second) continue;
      const auto material = static_cast<Material>(kShapeStone + rng.below(3));
      room.set(at, material);
      const Shape cube{ShapeForm::boxes, {ShapeBox{}}};
      for (const ShapeBox& box :
           (material == kShapeStone ? cube : shapes()[material].shape).boxes) {
        Ends ends;
        const std::array<double, 3> corner = {double(at.x), double(at.y), double(at.z)};
        for (std::size_t a = 0; a < 3; ++a) {
          ends.min[a] = corner[a] + box.min[a] / 16.0;
          ends.max[a] = corner[a] + box.max[a] / 16.0;
        }
        solid.push_back(ends);
      }
    }
    const BodyBox body = [&] {
      const double x = real(0, 15), y = real(0, 14), z = real(0, 15);
      return BodyBox{{x, y, z}, {x + 0.6, y + 1.8, z + 0.6}};
    }();
    const WorldPos by{real(-9, 9), real(-9, 9), real(-9, 9)};
    const auto hit = sweep(room, obstacles(), body, by);
    const double end = hit ? hit->fraction : 1;
    CAPTURE(round, body.min.x, body.min.y, body.min.z, by.x, by.y, by.z, end);
    // Boxes that the body overlaps at the start do not stop it.
    const auto is_left_out = [&](const Ends& e) {
      return depth_of(moved(body, by, 0), e) > kTouchDepth;
    };
    for (const Ends& e : solid) {
      if (is_left_out(e)) continue;
      for (int i = 0; i <= 200; ++i)
        REQUIRE(depth_of(moved(body, by, end * i / 200), e) <= 3 * kTouchDepth);
    }
    if (!hit) {
      ++free;
      continue;
    }
    ++hits;
    const double beyond = end + 1e-4;
    CHECK(std::any_of(solid.begin(), solid.end(), [&](const Ends& e) {
      return !is_left_out(e) && depth_of(moved(body, by, beyond), e) > 0;
    }));
  }
  CHECK(hits > 100);
  CHECK(free > 20);
}

}  // namespace runstone::test
