#include <catch2/catch.hpp>

#include <array>

#include "common/core/integer_root.hpp"
#include "common/edits/descriptor/capsule_row.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

// Capsules at the limits of a stroke, where an overflowing product would show first.
namespace runstone::test {
namespace {

// Returns a point anywhere in the world from which a stroke of any step and radius stays inside.
VoxelPos far_point(SplitMix64& rng) {
  constexpr std::int32_t kReach = kWorldLimit - kStrokeStepMax - kEditRadiusMax - 1;
  const auto c = [&] {
    return rng.below(3) == 0 ? (rng.below(2) == 0 ? -kReach : kReach)
                             : rng.between(-kReach, kReach);
  };
  return {c(), c(), c()};
}

std::int32_t long_step(SplitMix64& rng) {
  const auto draw = rng.below(4);
  if (draw == 0) return rng.below(2) == 0 ? -kStrokeStepMax : kStrokeStepMax;
  return draw == 1 ? rng.between(-3, 3) : rng.between(-kStrokeStepMax, kStrokeStepMax);
}

}  // namespace

TEST_CASE("whole square roots are exact, also where doubles are not", "[edits][property]") {
  SplitMix64 rng{5 + Catch::rngSeed()};
  const auto check = [](std::int64_t v) {
    if (v < 0 || v >= std::int64_t{1} << 62) return;
    const std::int64_t root = integer_root(v);
    REQUIRE(root * root <= v);
    REQUIRE((root + 1) * (root + 1) > v);
  };
  for (std::int64_t v = 0; v < 1000; ++v) check(v);
  check((std::int64_t{1} << 62) - 1);
  for (int round = 0; round < 100'000; ++round) {
    const auto root = static_cast<std::int64_t>(rng.next() >> (33 + rng.below(30)));
    for (const std::int64_t off : {-1, 0, 1}) check(root * root + off);
    check(static_cast<std::int64_t>(rng.next() >> 2));
  }
}

TEST_CASE("rows of the longest and widest strokes equal the oracle in any order",
          "[edits][property]") {
  SplitMix64 rng{31 + Catch::rngSeed()};
  int rim = 0;
  for (int round = 0; round < 1500; ++round) {
    FillStroke stroke;
    stroke.radius =
        static_cast<std::uint16_t>(rng.below(2) == 0 ? rng.between(400, 512) : rng.between(1, 40));
    const VoxelPos a = far_point(rng);
    const std::array<std::int32_t, 3> d = {long_step(rng), long_step(rng), long_step(rng)};
    const VoxelPos b{a.x + d[0], a.y + d[1], a.z + d[2]};
    if (a == b) continue;
    stroke.points = {a, b};
    const EditDescriptor edit{stroke, {}, 1};
    // A box near the surface: from a point of the segment, one radius away in some direction.
    const std::int32_t share = rng.between(0, 16), r = stroke.radius;
    const auto beside = [&](std::int32_t from, std::int32_t step) {
      const std::int32_t out =
          rng.below(2) == 0 ? rng.between(-r, r) : (rng.below(2) == 0 ? -r : r) * 9 / 16;
      return from + step * share / 16 + out - 5;
    };
    const VoxelPos origin{beside(a.x, d[0]), beside(a.y, d[1]), beside(a.z, d[2])};
    const Extent extent{10, 9, 11};
    const AxisOrder order = random_order(rng);
    CAPTURE(Catch::rngSeed(), round, edit, static_cast<int>(order), origin.x, origin.y, origin.z);
    const std::vector<IndexSpan> expected = oracle_spans(edit, origin, extent, order);
    std::vector<IndexSpan> spans;
    append_spans(edit, origin, extent, order, spans);
    REQUIRE(spans == expected);
    const VoxelBox box{origin, {origin.x + extent.x, origin.y + extent.y, origin.z + extent.z}};
    REQUIRE(touches(edit, box) == !expected.empty());
    rim += expected.size() > 1 ? 1 : 0;
  }
  CHECK(rim > 200);
}

TEST_CASE("a stroke at the largest coordinates is cut at the edge of the world", "[edits]") {
  constexpr std::int32_t kEnd = kWorldLimit - 1 - kEditRadiusMax;
  const FillStroke stroke{{{kEnd, kEnd, kEnd}, {kEnd - 1024, kEnd - 1024, kEnd - 1024}},
                          kEditRadiusMax};
  const EditDescriptor edit{stroke, {}, 1};
  REQUIRE(validate(edit).has_value());
  CHECK(bounding_box(edit).max == VoxelPos{kWorldLimit, kWorldLimit, kWorldLimit});
  CHECK(touches(edit, {{kWorldLimit - 1, kEnd, kEnd}, {kWorldLimit, kEnd + 1, kEnd + 1}}));
  CHECK_FALSE(
      touches(edit, {{kWorldLimit - 1, kEnd, kEnd + 23}, {kWorldLimit, kEnd + 1, kEnd + 24}}));
  CHECK(touched_chunks_bound(edit, 128) == 17 * 17 * 17);  // 2,049 voxels a side, off the grid
}

}  // namespace runstone::test
