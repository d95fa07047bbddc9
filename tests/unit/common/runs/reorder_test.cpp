#include "common/runs/reorder.hpp"

#include <catch2/catch.hpp>

#include "common/runs/run_builder.hpp"

using namespace runstone;

namespace {

// Layers of two materials, stacked along y.
RunChunk stacked(AxisOrder order) {
  const Extent extent{8, 16, 8};
  RunBuilder builder(extent, order);
  for (VoxelIndex i = 0; i < extent.volume(); ++i)
    builder.append(1, pos_of(i, extent, order).y < 5 ? 1 : 0);
  return builder.finish();
}

}  // namespace

TEST_CASE("flat ground needs two runs when y is slowest and two a column when y is fastest",
          "[runs][reorder]") {
  for (const AxisOrder order : kAxisOrders) {
    const auto runs = runs_per_order(stacked(order));
    CHECK(runs[static_cast<std::size_t>(AxisOrder::xzy)] == 2);
    CHECK(runs[static_cast<std::size_t>(AxisOrder::zxy)] == 2);
    CHECK(runs[static_cast<std::size_t>(AxisOrder::yxz)] == 128);
    CHECK(runs[static_cast<std::size_t>(AxisOrder::yzx)] == 128);
    CHECK(runs[static_cast<std::size_t>(AxisOrder::xyz)] == 16);
    CHECK(runs[static_cast<std::size_t>(AxisOrder::zyx)] == 16);
  }
}

TEST_CASE("ties go to the lower order number", "[runs][reorder]") {
  for (const AxisOrder order : kAxisOrders) {
    CHECK(cheapest_order(stacked(order)) == AxisOrder::xzy);  // zxy has two runs as well
    CHECK(cheapest_order(uniform_chunk(Extent::cube(8), 3, order)) == AxisOrder::xyz);
    CHECK(in_cheapest_order(stacked(order)) == stacked(AxisOrder::xzy));
  }
}

TEST_CASE("a uniform chunk stays one run in every order", "[runs][reorder]") {
  for (const AxisOrder order : kAxisOrders) {
    const RunChunk chunk = reorder(uniform_chunk({8, 40, 64}, 9), order);
    CHECK(chunk == uniform_chunk({8, 40, 64}, 9, order));
  }
}

TEST_CASE("a reordered chunk holds no spare capacity", "[runs][reorder]") {
  for (const AxisOrder from : kAxisOrders) {
    for (const AxisOrder to : kAxisOrders) {  // runs meet at the ends of many lines and merge
      if (from == to) continue;
      const RunChunk chunk = reorder(stacked(from), to);
      CHECK(chunk.runs.byte_capacity() == chunk.runs.byte_size());
    }
  }
}
