#include "common/runs/cut.hpp"

#include <catch2/catch.hpp>

#include "common/runs/reorder.hpp"
#include "common/runs/span_boxes.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("a cut has the voxels of its cuboid, mirrored on request, in canonical runs",
          "[runs][property]") {
  SplitMix64 rng{61 + Catch::rngSeed()};
  int whole_lines = 0;
  for (int round = 0; round < 2000; ++round) {
    const Extent extent = random_extent(rng, 30);
    const RunChunk chunk = random_chunk(rng, extent, random_order(rng), 5);
    // Whole sides are frequent.
    const auto range = [&rng](unsigned side) {
      if (rng.below(3) == 0) return std::array<std::uint8_t, 2>{0, static_cast<std::uint8_t>(side)};
      const std::uint32_t first = rng.below(side);
      return std::array<std::uint8_t, 2>{static_cast<std::uint8_t>(first),
                                         static_cast<std::uint8_t>(1 + rng.below(side - first))};
    };
    const auto x = range(extent.x), y = range(extent.y), z = range(extent.z);
    const Extent sides{x[1], y[1], z[1]};
    const auto mirrored = static_cast<std::uint8_t>(rng.below(2) == 0 ? 0 : rng.below(8));
    CAPTURE(Catch::rngSeed(), round, static_cast<int>(chunk.order), static_cast<int>(mirrored));
    const RunChunk part = cut(chunk, {x[0], y[0], z[0]}, sides, mirrored);
    REQUIRE(part.extent == sides);
    REQUIRE(part.order == chunk.order);
    REQUIRE(validate_runs(part).has_value());
    const DenseChunk from = DenseChunk::of(chunk);
    DenseChunk expected(sides);
    for (int i = 0; i < sides.x; ++i) {
      for (int j = 0; j < sides.y; ++j) {
        for (int k = 0; k < sides.z; ++k) {
          const int a = (mirrored & 1) != 0 ? sides.x - 1 - i : i;
          const int b = (mirrored & 2) != 0 ? sides.y - 1 - j : j;
          const int c = (mirrored & 4) != 0 ? sides.z - 1 - k : k;
          expected.set(i, j, k, from.at(x[0] + a, y[0] + b, z[0] + c));
        }
      }
    }
    REQUIRE(DenseChunk::of(part) == expected);
    const AxisOrder order = random_order(rng);
    const RunChunk turned = reorder(part, order);  // sides below a chunk's, too
    REQUIRE(validate_runs(turned).has_value());
    REQUIRE(DenseChunk::of(turned) == expected);
    REQUIRE(runs_per_order(part)[static_cast<std::size_t>(order)] == turned.runs.size());
    whole_lines += sides == extent ? 1 : 0;
  }
  CHECK(whole_lines > 20);
}

TEST_CASE("the boxes of a stretch are at most five and hold its voxels in index order",
          "[runs][property]") {
  SplitMix64 rng{62 + Catch::rngSeed()};
  for (int round = 0; round < 3000; ++round) {
    const OrderedExtent e{1 + rng.below(9), 1 + rng.below(9), 1 + rng.below(9)};
    const std::uint32_t first = rng.below(e.volume());
    const std::uint32_t last = first + rng.below(e.volume() - first + 1);
    CAPTURE(Catch::rngSeed(), round, e.f, e.m, e.s, first, last);
    std::vector<std::uint32_t> voxels;
    int boxes = 0;
    for_each_box(e, first, last, [&](const OrderedBox& box) {
      ++boxes;
      for (std::uint32_t s = box.first[2]; s < box.last[2]; ++s) {
        for (std::uint32_t m = box.first[1]; m < box.last[1]; ++m) {
          for (std::uint32_t f = box.first[0]; f < box.last[0]; ++f)
            voxels.push_back(f + e.f * (m + e.m * s));
        }
      }
    });
    REQUIRE(boxes <= 5);
    REQUIRE(voxels.size() == last - first);
    for (std::uint32_t i = 0; i < voxels.size(); ++i) REQUIRE(voxels[i] == first + i);
  }
}

}  // namespace runstone::test
