#include "server/world/order/wait_histogram.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("waits are counted below each bound that they do not exceed", "[world]") {
  WaitHistogram waits;
  for (const TimeUs wait_us : {0, 1'000, 1'001, 20'000, 1'000'000, 1'000'001, 90'000'000})
    waits.add(wait_us);
  CHECK(waits.count() == 7);
  CHECK(waits.sum_us() == 92'022'002);
  CHECK(waits.at_most(0) == 2);  // 1 ms
  CHECK(waits.at_most(1) == 3);  // 2 ms
  CHECK(waits.at_most(3) == 3);  // 10 ms
  CHECK(waits.at_most(4) == 4);  // 20 ms
  CHECK(waits.at_most(9) == 5);  // 1 s
}
