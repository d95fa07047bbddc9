// No partition into rectangles has fewer. The tests compare it with all partitions of every small
// region, and with the formula for planes of any size.
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "tests/reference/minimum_partition.hpp"
#include "tests/support/mesh/partition_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

using namespace reference;

FacePlane plane_of_bits(std::uint64_t region, unsigned width, unsigned height) {
  FacePlane plane;
  plane.width = width;
  plane.height = height;
  for (unsigned cell = 0; cell < width * height; ++cell) {
    plane.faces.push_back((region >> cell & 1) != 0 ? Material{1} : kEmpty);
  }
  return plane;
}

/// Returns blobs and noise of some materials.
FacePlane random_plane(SplitMix64& rng, unsigned side_max, unsigned materials) {
  FacePlane plane;
  plane.width = 1 + rng.below(side_max);
  plane.height = 1 + rng.below(side_max);
  plane.faces.assign(static_cast<std::size_t>(plane.width) * plane.height,
                     static_cast<Material>(rng.below(materials)));
  const std::uint32_t boxes = rng.below(2 * side_max);
  for (std::uint32_t i = 0; i < boxes; ++i) {
    const std::uint32_t u = rng.below(plane.width);
    const std::uint32_t v = rng.below(plane.height);
    const std::uint32_t width = 1 + rng.below(plane.width - u);
    const std::uint32_t height = 1 + rng.below(plane.height - v);
    const auto material = static_cast<Material>(rng.below(materials));
    for (std::uint32_t row = v; row < v + height; ++row)
      std::fill_n(plane.row(row) + u, width, material);
  }
  const std::uint32_t noise = rng.below(4) == 0 ? rng.below(100) : 0;
  for (Material& face : plane.faces) {
    if (rng.below(100) < noise) face = static_cast<Material>(rng.below(materials));
  }
  return plane;
}

TEST_CASE("every region of 4 x 5 and of 5 x 3 cells is tiled by the fewest possible rectangles",
          "[mesh][property][reference]") {
  for (const auto& [width, height] : {std::pair{4u, 5u}, std::pair{5u, 3u}}) {
    LeastRectangles least(width, height);
    MinimumPartition partition;
    std::vector<PlaneRectangle> rectangles;
    const std::uint64_t regions = std::uint64_t{1} << (width * height);
    std::uint64_t region = 0;
    bool right = true;
    for (; region < regions && right; ++region) {
      const FacePlane plane = plane_of_bits(region, width, height);
      partition.find(plane, rectangles);
      right = partition_fault(plane, rectangles).empty() && rectangles.size() == least.of(region);
    }
    CAPTURE(width, height, region - 1);
    REQUIRE(right);
  }
}

TEST_CASE("random regions of 6 x 6 cells are tiled by the fewest possible rectangles",
          "[mesh][property][reference]") {
  SplitMix64 rng(Catch::rngSeed() + 31);
  LeastRectangles least(6, 6);
  MinimumPartition partition;
  std::vector<PlaneRectangle> rectangles;
  for (int round = 0; round < 1000; ++round) {
    // Nearly full regions have holes, chords that cross, and corners that touch.
    std::uint64_t region = (std::uint64_t{1} << 36) - 1;
    const std::uint32_t missing = rng.below(16);
    for (std::uint32_t i = 0; i < missing; ++i) region &= ~(std::uint64_t{1} << rng.below(36));
    const FacePlane plane = plane_of_bits(region, 6, 6);
    partition.find(plane, rectangles);
    CAPTURE(Catch::rngSeed(), round, region);
    REQUIRE(partition_fault(plane, rectangles) == "");
    REQUIRE(rectangles.size() == least.of(region));
    REQUIRE(rectangles.size() == least_rectangles_by_formula(plane));
  }
}

TEST_CASE("planes of several materials have the number of rectangles that the formula gives",
          "[mesh][property][reference]") {
  SplitMix64 rng(Catch::rngSeed() + 32);
  MinimumPartition partition;
  std::vector<PlaneRectangle> rectangles;
  for (int round = 0; round < 3000; ++round) {
    const unsigned side_max = round % 500 == 0 ? 128 : round % 10 == 0 ? 40 : 16;
    const FacePlane plane = random_plane(rng, side_max, 2 + rng.below(3));
    partition.find(plane, rectangles);
    CAPTURE(Catch::rngSeed(), round, plane.width, plane.height);
    REQUIRE(partition_fault(plane, rectangles) == "");
    REQUIRE(rectangles.size() == least_rectangles_by_formula(plane));
  }
}

TEST_CASE("an independent set leaves no edge and is as large as a matching allows",
          "[mesh][property][reference]") {
  SplitMix64 rng(Catch::rngSeed() + 33);
  IndependentSet set;
  BipartiteGraph graph;
  for (int round = 0; round < 5000; ++round) {
    graph.clear();
    graph.right_count = rng.below(round % 100 == 0 ? 200 : 12);
    const std::uint32_t left_count = rng.below(round % 100 == 0 ? 200 : 12);
    const std::uint32_t density = 1 + rng.below(60);
    for (std::uint32_t left = 0; left < left_count; ++left) {
      for (std::uint32_t right = 0; right < graph.right_count; ++right) {
        if (rng.below(100) < density) graph.edges.push_back(right);
      }
      graph.end_left();
    }
    set.find(graph);
    std::size_t size = 0;
    int joined = 0;
    for (std::uint32_t left = 0; left < left_count; ++left) {
      size += set.has_left(left) ? 1u : 0u;
      for (std::uint32_t e = graph.first[left]; e < graph.first[left + 1]; ++e) {
        joined += set.has_left(left) && set.has_right(graph.edges[e]) ? 1 : 0;
      }
    }
    for (std::uint32_t right = 0; right < graph.right_count; ++right)
      size += set.has_right(right) ? 1u : 0u;
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(joined == 0);
    REQUIRE(size == left_count + graph.right_count - matching_size(graph));
  }
}

}  // namespace
}  // namespace runstone::test
