#include <algorithm>
#include <catch2/catch.hpp>

#include "common/runs/layer.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using test::DenseChunk;

namespace {

void check_orders(const RunChunk& chunk) {
  const DenseChunk oracle = DenseChunk::of(chunk);
  const Digest digest = digest_of(chunk);
  REQUIRE(digest == oracle.digest());
  const auto counts = runs_per_order(chunk);
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(static_cast<int>(chunk.order), static_cast<int>(order), int{chunk.extent.x},
            int{chunk.extent.y}, int{chunk.extent.z}, chunk.runs.size());
    const RunChunk turned = reorder(chunk, order);
    REQUIRE(turned.order == order);
    REQUIRE(validate(turned).has_value());
    REQUIRE(DenseChunk::of(turned) == oracle);
    REQUIRE(counts[static_cast<std::size_t>(order)] == oracle.run_count(order));
    REQUIRE(turned.runs.size() == oracle.run_count(order));
    REQUIRE(digest_of(turned) == digest);
    REQUIRE(reorder(turned, chunk.order) == chunk);
  }
  const auto least = std::min_element(counts.begin(), counts.end());
  REQUIRE(cheapest_order(chunk) == kAxisOrders[static_cast<std::size_t>(least - counts.begin())]);
  const RunChunk cheapest = in_cheapest_order(chunk);
  REQUIRE(cheapest.runs.size() == *least);
  REQUIRE(cheapest == reorder(chunk, cheapest_order(chunk)));
}

}  // namespace

TEST_CASE("changing the axis order keeps every voxel, the digest and the counted runs",
          "[runs][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  CAPTURE(Catch::rngSeed());
  for (int round = 0; round < 150; ++round) {
    check_orders(test::random_chunk(rng, 20, 2 + rng.below(4)));
  }
}

TEST_CASE("every extent reorders from every order into every order", "[runs][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  CAPTURE(Catch::rngSeed());
  for (int shape = 0; shape < test::kShapeCount; ++shape) {
    for (const AxisOrder order : kAxisOrders) {
      check_orders(
          test::random_chunk(rng, {8, 9, 10}, order, 3, static_cast<test::ChunkShape>(shape)));
    }
  }
}

TEST_CASE("the axis order changes between the narrow and the wide form's limits too",
          "[runs][property]") {
  SplitMix64 rng{Catch::rngSeed() + 2};
  CAPTURE(Catch::rngSeed());
  check_orders(test::random_chunk(rng, {71, 71, 13}, AxisOrder::zxy, 4, test::ChunkShape::noise));
  check_orders(
      test::random_chunk(rng, {32, 32, 64}, AxisOrder::yzx, 4, test::ChunkShape::speckled));
  check_orders(test::random_chunk(rng, {8, 128, 65}, AxisOrder::xyz, 4, test::ChunkShape::columns));
}

TEST_CASE("a layer reads as the oracle's voxels, along every axis and either way round",
          "[runs][property]") {
  SplitMix64 rng{Catch::rngSeed() + 3};
  CAPTURE(Catch::rngSeed());
  const auto at = [](const DenseChunk& dense, std::array<std::uint32_t, 3> c) {
    return dense.at(static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2]));
  };
  for (int round = 0; round < 60; ++round) {
    const RunChunk chunk = test::random_chunk(
        rng, test::random_extent(rng, round % 10 == 9 ? 70 : 16), test::random_order(rng), 4);
    const DenseChunk oracle = DenseChunk::of(chunk);
    const auto sides = chunk.extent.sides();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t u = 0; u < 3; ++u) {
        if (u == axis) continue;
        const std::size_t v = 3 - axis - u;
        std::vector<Material> out(std::size_t{sides[u]} * sides[v], 0xdead);
        for (const std::uint32_t place : {0U, rng.below(sides[axis]), sides[axis] - 1U}) {
          read_layer(chunk, static_cast<Axis>(axis), place, static_cast<Axis>(u), out);
          std::size_t wrong = 0;
          for (std::uint32_t j = 0; j < sides[v]; ++j) {
            for (std::uint32_t i = 0; i < sides[u]; ++i) {
              std::array<std::uint32_t, 3> c{};
              c[axis] = place;
              c[u] = i;
              c[v] = j;
              wrong += out[i + std::size_t{sides[u]} * j] != at(oracle, c);
            }
          }
          CAPTURE(static_cast<int>(chunk.order), axis, u, place);
          REQUIRE(wrong == 0);
        }
      }
    }
  }
}

TEST_CASE("a span's digest is the sum over its voxels, wherever it begins and ends",
          "[runs][property]") {
  SplitMix64 rng{Catch::rngSeed() + 4};
  CAPTURE(Catch::rngSeed());
  for (int round = 0; round < 400; ++round) {
    const Extent extent = test::random_extent(rng, 14);
    const AxisOrder order = test::random_order(rng);
    const RunChunk shape = uniform_chunk(extent, 0, order);
    const std::uint32_t a = rng.below(extent.volume() + 1);
    const std::uint32_t b = rng.below(4) == 0 ? extent.volume() : rng.below(extent.volume() + 1);
    const auto material = static_cast<Material>(rng.below(65536));
    DenseChunk oracle(extent);
    oracle.fill(order, std::min(a, b), std::max(a, b) - std::min(a, b), material);
    CAPTURE(a, b, material, static_cast<int>(order));
    REQUIRE(digest_of_span(shape, std::min(a, b), std::max(a, b), material) == oracle.digest());
  }
  const RunChunk largest = uniform_chunk(Extent::cube(128), 1, AxisOrder::zxy);
  CHECK(digest_of_span(largest, 0, largest.volume(), 5) ==
        digest_of_box(5, {0, 0, 0}, {128, 128, 128}));
  CHECK(digest_of_span(largest, 77, 77, 5) == Digest{});
  CHECK(digest_of_span(largest, largest.volume(), largest.volume(), 5) == Digest{});
}

TEST_CASE("random chunks are valid and cover their promised range", "[runs][property]") {
  SplitMix64 rng{Catch::rngSeed() + 5};
  CAPTURE(Catch::rngSeed());
  bool orders[kAxisOrderCount] = {};
  int uniform = 0;
  int wide = 0;
  std::size_t runs_most = 0;
  for (int round = 0; round < 400; ++round) {
    const RunChunk chunk = test::random_chunk(rng);
    REQUIRE(validate(chunk).has_value());
    orders[static_cast<std::size_t>(chunk.order)] = true;
    uniform += chunk.is_uniform();
    wide += !chunk.runs.is_narrow();
    runs_most = std::max(runs_most, chunk.runs.size());
  }
  CHECK(std::all_of(std::begin(orders), std::end(orders), [](bool seen) { return seen; }));
  CHECK(uniform > 5);
  CHECK(wide > 2);
  CHECK(runs_most > 5000);
}
