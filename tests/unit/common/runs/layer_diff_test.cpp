#include "common/runs/layer_diff.hpp"

#include <catch2/catch.hpp>

#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

DirtyLayers compare_voxels(const RunChunk& a, const RunChunk& b) {
  const DenseChunk left = DenseChunk::of(a);
  const DenseChunk right = DenseChunk::of(b);
  DirtyLayers out;
  for (int x = 0; x < left.side_x(); ++x) {
    for (int y = 0; y < left.side_y(); ++y) {
      for (int z = 0; z < left.side_z(); ++z) {
        if (left.at(x, y, z) == right.at(x, y, z)) continue;
        out.layer[0].set(static_cast<std::size_t>(x));
        out.layer[1].set(static_cast<std::size_t>(y));
        out.layer[2].set(static_cast<std::size_t>(z));
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("changed layers are exactly those in which a voxel differs", "[replica]") {
  SplitMix64 rng{Catch::rngSeed() + 11};
  for (int round = 0; round < 300; ++round) {
    const Extent extent = random_extent(rng, 24);
    const AxisOrder order = random_order(rng);
    const RunChunk before = random_chunk(rng, extent, order, 4);
    RunChunk after = before;
    const int fills = rng.between(0, 3);
    for (int i = 0; i < fills; ++i) {
      const std::uint32_t first = rng.below(after.volume());
      const std::uint32_t most =
          rng.below(4) == 0 ? after.volume() - first : std::min(40U, after.volume() - first);
      fill(after, first, 1 + rng.below(most), static_cast<Material>(rng.below(4)));
    }
    CAPTURE(round, fills);
    REQUIRE(changed_layers(before, after) == compare_voxels(before, after));
    REQUIRE(changed_layers(after, after) == DirtyLayers{});
  }
}

TEST_CASE("in another axis order equal voxels are no change and others are a change of everything",
          "[replica]") {
  const Extent extent{8, 9, 10};
  RunChunk before = uniform_chunk(extent, 1, AxisOrder::xyz);
  fill(before, 100, 30, 2);
  RunChunk after = uniform_chunk(extent, 1, AxisOrder::zyx);
  const DenseChunk voxels = DenseChunk::of(before);
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 9; ++y) {
      for (int z = 0; z < 10; ++z) {
        const LocalPos at{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                          static_cast<std::uint8_t>(z)};
        fill(after, index_of(at, extent, after.order), 1, voxels.at(x, y, z));
      }
    }
  }
  CHECK_FALSE(changed_layers(before, after).any());
  fill(after, 0, 1, 3);
  CHECK(changed_layers(before, after) == all_layers(extent));
  CHECK(all_layers(extent).layer[0].count() == 8);
  CHECK(all_layers(extent).layer[1].count() == 9);
  CHECK(all_layers(extent).layer[2].count() == 10);
}

TEST_CASE("the layer that touches a neighbour is the first or the last along its axis",
          "[replica]") {
  DirtyLayers dirty;
  dirty.layer[1].set(0);
  CHECK(border_dirty(dirty, Direction::neg_y, 16));
  CHECK_FALSE(border_dirty(dirty, Direction::pos_y, 16));
  dirty.layer[2].set(15);
  CHECK(border_dirty(dirty, Direction::pos_z, 16));
  CHECK_FALSE(border_dirty(dirty, Direction::neg_z, 16));
  CHECK_FALSE(border_dirty(dirty, Direction::pos_x, 16));
}
