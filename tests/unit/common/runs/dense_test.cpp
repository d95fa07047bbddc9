#include "common/runs/dense.hpp"

#include <catch2/catch.hpp>

#include "common/runs/layer.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;

TEST_CASE("every dense expansion is counted", "[runs][dense]") {
  const RunChunk chunk = uniform_chunk(Extent::cube(8), 3);
  const std::uint64_t before = dense_expansions();
  to_dense(chunk);
  CHECK(dense_expansions() == before + 1);
  count_dense_expansion();
  CHECK(dense_expansions() == before + 2);
  const auto oracle = test::DenseChunk::of(chunk);
  CHECK(dense_expansions() == before + 3);
}

TEST_CASE("work on runs expands nothing", "[runs][dense]") {
  SplitMix64 rng(1);
  const std::uint64_t before = dense_expansions();
  RunChunk chunk = test::random_chunk(rng);
  fill(chunk, 5, 100, 7);
  digest_of(chunk);
  REQUIRE(validate(chunk).has_value());
  runs_per_order(chunk);
  for (const AxisOrder order : kAxisOrders) reorder(chunk, order);
  std::vector<Material> layer(std::size_t{chunk.extent.y} * chunk.extent.z);
  read_layer(chunk, Axis::x, 0, Axis::y, layer);
  in_cheapest_order(std::move(chunk));
  CHECK(dense_expansions() == before);
}

TEST_CASE("a dense buffer and its runs convert into each other", "[runs][dense]") {
  SplitMix64 rng(2);
  for (int i = 0; i < 60; ++i) {
    const RunChunk chunk = test::random_chunk(rng, 20, 5);
    const std::vector<Material> dense = to_dense(chunk);
    REQUIRE(dense.size() == chunk.volume());
    const auto oracle = test::DenseChunk::of(chunk);
    for (std::uint32_t v = 0; v < chunk.volume(); ++v) {
      const VoxelPos p = test::dense_pos(chunk.extent, chunk.order, v);
      REQUIRE(dense[v] == oracle.at(p.x, p.y, p.z));
    }
    REQUIRE(*from_dense(chunk.extent, chunk.order, dense) == chunk);
  }
}
