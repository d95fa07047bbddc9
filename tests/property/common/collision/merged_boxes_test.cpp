#include "common/collision/merged_boxes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <string>

#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

/// Counts how often each voxel is covered, voxel by voxel. Returns the first one that is covered
/// wrongly, as text.
std::optional<std::string> wrong_cover(const DenseChunk& chunk, const MaterialSet& solid,
                                       const std::vector<MergedBox>& boxes) {
  std::vector<unsigned> times(chunk.extent().volume(), 0);
  const auto slot = [&](int x, int y, int z) {
    return static_cast<std::size_t>(x + chunk.side_x() * (y + chunk.side_y() * z));
  };
  for (const MergedBox& box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box.min[axis] >= box.max[axis]) return "an empty box";
    }
    for (int z = box.min[2]; z < box.max[2]; ++z) {
      for (int y = box.min[1]; y < box.max[1]; ++y) {
        for (int x = box.min[0]; x < box.max[0]; ++x) {
          if (!chunk.inside(x, y, z)) return "a box that leaves the chunk";
          ++times[slot(x, y, z)];
        }
      }
    }
  }
  for (int z = 0; z < chunk.side_z(); ++z) {
    for (int y = 0; y < chunk.side_y(); ++y) {
      for (int x = 0; x < chunk.side_x(); ++x) {
        const unsigned expected = solid.contains(chunk.at(x, y, z)) ? 1 : 0;
        if (times[slot(x, y, z)] != expected) {
          return std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " is in " +
                 std::to_string(times[slot(x, y, z)]) + " boxes";
        }
      }
    }
  }
  return std::nullopt;
}

MaterialSet random_set(SplitMix64& rng) {
  std::vector<bool> has(rng.below(8));
  for (std::size_t i = 0; i < has.size(); ++i) has[i] = rng.below(2) != 0;
  if (!has.empty()) has[0] = false;
  return {has, rng.below(2) != 0};
}

}  // namespace

TEST_CASE("merged boxes cover each solid voxel once and no other", "[collision][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 200; ++round) {
    const RunChunk chunk = random_chunk(rng);
    const MaterialSet solid = random_set(rng);
    std::vector<MergedBox> boxes;
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(merge_boxes(chunk, solid, kMergedBoxesMax, boxes).has_value());
    CHECK(wrong_cover(DenseChunk::of(chunk), solid, boxes).value_or("") == "");
    // A limit that just suffices, and one that does not.
    const std::size_t count = boxes.size();
    std::vector<MergedBox> again;
    CHECK(merge_boxes(chunk, solid, count, again).has_value());
    CHECK(again == boxes);
    if (count > 0) CHECK_FALSE(merge_boxes(chunk, solid, count - 1, again).has_value());
  }
}

TEST_CASE("the cover of merged boxes is found wrong where it is", "[collision][property]") {
  const RunChunk chunk = uniform_chunk(Extent::cube(8), 1);
  const DenseChunk dense = DenseChunk::of(chunk);
  CHECK_FALSE(wrong_cover(dense, {}, {{{0, 0, 0}, {8, 8, 8}}}).has_value());
  CHECK(wrong_cover(dense, {}, {{{0, 0, 0}, {8, 8, 7}}}).has_value());
  CHECK(wrong_cover(dense, {}, {{{0, 0, 0}, {8, 8, 8}}, {{1, 1, 1}, {2, 2, 2}}}).has_value());
  CHECK(wrong_cover(dense, {}, {{{0, 0, 0}, {8, 8, 9}}}).has_value());
  CHECK(wrong_cover(DenseChunk::of(uniform_chunk(Extent::cube(8), 0)), {}, {{{0, 0, 0}, {1, 1, 1}}})
            .has_value());
}

}  // namespace runstone::test
