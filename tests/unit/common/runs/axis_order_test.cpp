#include "common/runs/axis_order.hpp"

#include <catch2/catch.hpp>

#include "tests/support/runs/dense_chunk.hpp"

using namespace runstone;

TEST_CASE("every index names one voxel and every voxel one index, in all orders",
          "[runs][axis_order]") {
  const Extent extent{8, 11, 9};
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(static_cast<int>(order));
    for (VoxelIndex i = 0; i < extent.volume(); ++i) {
      const LocalPos p = pos_of(i, extent, order);
      REQUIRE(test::dense_pos(extent, order, i) == VoxelPos{p.x, p.y, p.z});
      REQUIRE(index_of(p, extent, order) == i);
    }
  }
}

TEST_CASE("an order is named fastest axis first", "[runs][axis_order]") {
  const Extent extent{8, 16, 32};
  CHECK(index_of({1, 0, 0}, extent, AxisOrder::xyz) == 1);
  CHECK(index_of({0, 1, 0}, extent, AxisOrder::xyz) == 8);
  CHECK(index_of({0, 0, 1}, extent, AxisOrder::xyz) == 128);
  CHECK(index_of({0, 0, 1}, extent, AxisOrder::zxy) == 1);
  CHECK(index_of({1, 0, 0}, extent, AxisOrder::zxy) == 32);
  CHECK(index_of({0, 1, 0}, extent, AxisOrder::zxy) == 256);
}

TEST_CASE("an ordered position converts back to the local one", "[runs][axis_order]") {
  for (const AxisOrder order : kAxisOrders) {
    const LocalPos p{3, 5, 7};
    CHECK(from_ordered(to_ordered(p, order), order) == p);
    const OrderedExtent e = ordered({3, 5, 7}, order);
    CHECK(e.volume() == 105);
    CHECK(e.layer() == e.f * e.m);
  }
}
