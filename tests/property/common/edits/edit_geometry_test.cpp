#include <catch2/catch.hpp>

#include <set>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/height_limits.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("voxel counts and bounding boxes equal a count of single voxels", "[edits][property]") {
  SplitMix64 rng{21 + Catch::rngSeed()};
  for (int round = 0; round < 80; ++round) {
    EditDescriptor edit = random_edit_near(rng, {-4, -4, -4}, Extent::cube(8));
    if (auto* ball = std::get_if<FillSphere>(&edit.shape))
      ball->radius = static_cast<std::uint16_t>(round % 24);
    CAPTURE(Catch::rngSeed(), round, edit);
    const auto voxels = oracle_voxels(edit, {}, 60);
    if (std::holds_alternative<FillStroke>(edit.shape)) {  // an upper bound
      REQUIRE(counted_voxels(edit) >= voxels.size());
    } else {
      REQUIRE(counted_voxels(edit) == voxels.size());
    }
    VoxelBox tight{voxels.front(), voxels.front()};
    for (const VoxelPos p : voxels) {
      tight.min = {std::min(tight.min.x, p.x), std::min(tight.min.y, p.y),
                   std::min(tight.min.z, p.z)};
      tight.max = {std::max(tight.max.x, p.x + 1), std::max(tight.max.y, p.y + 1),
                   std::max(tight.max.z, p.z + 1)};
    }
    REQUIRE(bounding_box(edit) == tight);
  }
}

TEST_CASE("an edit is within height limits when each of its voxels is", "[edits][property]") {
  SplitMix64 rng{24 + Catch::rngSeed()};
  int inside = 0, partly = 0;
  for (int round = 0; round < 400; ++round) {
    EditDescriptor edit = random_edit_near(rng, {-4, -4, -4}, Extent::cube(8));
    if (auto* ball = std::get_if<FillSphere>(&edit.shape))
      ball->radius = static_cast<std::uint16_t>(rng.below(9));
    const VoxelBox box = bounding_box(edit);  // limits close to the ends of the box
    HeightLimits limits{box.min.y + rng.between(-2, 1), box.max.y + rng.between(-1, 2)};
    if (limits.y_max <= limits.y_min) limits.y_max = limits.y_min + 1;
    CAPTURE(Catch::rngSeed(), round, edit, limits.y_min, limits.y_max);
    std::size_t voxels = 0, between = 0;
    for (const VoxelPos p : oracle_voxels(edit, {}, 54)) {
      ++voxels;
      between += p.y >= limits.y_min && p.y < limits.y_max ? 1 : 0;
    }
    REQUIRE(within(edit, limits) == (between == voxels));
    inside += between == voxels ? 1 : 0;
    partly += between != 0 && between != voxels ? 1 : 0;
  }
  CHECK(inside > 50);
  CHECK(partly > 50);
}

TEST_CASE("touched chunks are the chunks of the single voxels", "[edits][property]") {
  SplitMix64 rng{22 + Catch::rngSeed()};
  for (int round = 0; round < 60; ++round) {
    EditDescriptor edit = random_edit_near(rng, {-4, -4, -4}, Extent::cube(8));
    if (auto* ball = std::get_if<FillSphere>(&edit.shape))
      ball->radius = static_cast<std::uint16_t>(rng.below(40));
    CAPTURE(Catch::rngSeed(), round, edit);
    for (const std::int32_t edge : {16, 32}) {
      std::set<ChunkCoord> expected;  // ascends like the protocol's list
      for (const VoxelPos p : oracle_voxels(edit, {}, 60)) {
        const auto chunk = [edge](std::int32_t c) { return (c + 64 * edge) / edge - 64; };
        expected.insert({chunk(p.x), chunk(p.y), chunk(p.z)});
      }
      REQUIRE(touched_chunks(edit, edge) ==
              std::vector<ChunkCoord>(expected.begin(), expected.end()));
      REQUIRE(touched_chunks_bound(edit, edge) >= expected.size());
    }
  }
}

TEST_CASE("a stroke's count stays above the voxels of each segment", "[edits][property]") {
  SplitMix64 rng{25 + Catch::rngSeed()};
  for (int round = 0; round < 300; ++round) {
    FillStroke stroke;
    stroke.radius = static_cast<std::uint16_t>(rng.between(1, 12));
    const std::int32_t side = rng.below(2) == 0 ? 5 : 40;
    const VoxelPos to{rng.between(-side, side), rng.between(-side, side), rng.between(1, side)};
    // Space diagonals have the widest sections.
    stroke.points = {{0, 0, 0}, round % 3 == 0 ? VoxelPos{to.z, to.z, -to.z} : to};
    const EditDescriptor edit{stroke, {}, 1};
    CAPTURE(Catch::rngSeed(), round, edit);
    const VoxelBox box = bounding_box(edit);
    const VoxelPos& low = box.min;
    std::uint64_t voxels = 0;
    std::vector<IndexSpan> spans;  // tested against single voxels below
    for (VoxelPos at = low; at.x < box.max.x; at.x += 64) {
      for (at.y = low.y; at.y < box.max.y; at.y += 64) {
        for (at.z = low.z; at.z < box.max.z; at.z += 64) {
          spans.clear();
          append_spans(edit, at, Extent::cube(64), AxisOrder::xyz, spans);
          for (const IndexSpan& span : spans) voxels += span.last - span.first;
        }
      }
    }
    REQUIRE(counted_voxels(edit) >= voxels);
    REQUIRE(counted_voxels(edit) < 4 * voxels);
  }
}

TEST_CASE("an edit touches a box when one of its voxels is inside", "[edits][property]") {
  SplitMix64 rng{23 + Catch::rngSeed()};
  for (int round = 0; round < 2000; ++round) {
    const EditDescriptor edit = random_edit_near(rng, {}, Extent::cube(16));
    const VoxelPos min{rng.between(-10, 26), rng.between(-10, 26), rng.between(-10, 26)};
    const VoxelBox box{
        min, {min.x + rng.between(0, 5), min.y + rng.between(0, 5), min.z + rng.between(0, 5)}};
    bool expected = false;
    for (VoxelPos p = min; p.x < box.max.x; ++p.x) {
      for (p.y = min.y; p.y < box.max.y; ++p.y) {
        for (p.z = min.z; p.z < box.max.z; ++p.z) expected = expected || oracle_covers(edit, p);
      }
    }
    CAPTURE(Catch::rngSeed(), round, edit);
    REQUIRE(touches(edit, box) == expected);
  }
}

TEST_CASE("a paste touches a box inside it where a cell of the box is touched",
          "[edits][property]") {
  SplitMix64 rng{26 + Catch::rngSeed()};
  int misses = 0;
  for (int round = 0; round < 400; ++round) {
    const Paste paste{{rng.between(-9, 9), rng.between(-9, 9), rng.between(-9, 9)},
                      random_clipboard(rng, 12, 3),
                      random_orientation(rng)};
    const EditDescriptor edit{paste, {}, kEmpty};
    const VoxelBox whole = bounding_box(edit);
    for (int i = 0; i < 30; ++i) {
      const auto low = [&rng](std::int32_t from, std::int32_t to) {
        return rng.between(from, to - 1);
      };
      const VoxelPos min{low(whole.min.x, whole.max.x), low(whole.min.y, whole.max.y),
                         low(whole.min.z, whole.max.z)};
      const auto side = [&rng] { return rng.between(1, 3); };
      const VoxelBox box{min, {min.x + side(), min.y + side(), min.z + side()}};
      bool expected = false;
      for (VoxelPos p = min; p.x < box.max.x; ++p.x) {
        for (p.y = min.y; p.y < box.max.y; ++p.y) {
          for (p.z = min.z; p.z < box.max.z; ++p.z) expected = expected || oracle_covers(edit, p);
        }
      }
      CAPTURE(Catch::rngSeed(), round, edit, min.x, min.y, min.z);
      REQUIRE(touches(edit, box) == expected);
      misses += expected ? 0 : 1;
    }
  }
  CHECK(misses > 500);
}

TEST_CASE("spans are the maximal stretches of covered voxels in index order", "[edits][property]") {
  SplitMix64 rng{24 + Catch::rngSeed()};
  for (int round = 0; round < 3000; ++round) {
    const Extent extent = random_extent(rng, 24);
    const AxisOrder order = random_order(rng);
    const VoxelPos origin{rng.between(-50, 50), rng.between(-50, 50), rng.between(-50, 50)};
    const EditDescriptor edit = random_edit_near(rng, origin, extent);
    CAPTURE(Catch::rngSeed(), round, edit, static_cast<int>(order));
    const std::vector<IndexSpan> expected = oracle_spans(edit, origin, extent, order);
    std::vector<IndexSpan> spans;
    append_spans(edit, origin, extent, order, spans);
    REQUIRE(spans == expected);
  }
}

}  // namespace runstone::test
