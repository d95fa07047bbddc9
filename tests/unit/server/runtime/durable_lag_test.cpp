#include "server/runtime/durable_lag.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("the oldest edit that is not on disk makes the durable lag", "[server]") {
  DurableLag lag;
  lag.observe(10, 10, 1'000);
  CHECK(lag.lag_us(5'000) == 0);
  lag.observe(12, 10, 2'000);
  lag.observe(15, 10, 4'000);
  CHECK(lag.lag_us(5'000) == 3'000);
  lag.observe(15, 11, 6'000);  // one of the first two
  CHECK(lag.lag_us(6'000) == 4'000);
  CHECK(lag.waits().count() == 0);
  lag.observe(15, 12, 7'000);
  CHECK(lag.lag_us(7'000) == 3'000);
  lag.observe(15, 15, 9'000);
  CHECK(lag.lag_us(9'000) == 0);
  CHECK(lag.waits().count() == 5);
  CHECK(lag.waits().sum_us() == 2 * 5'000 + 3 * 5'000);
  CHECK(lag.waits().at_most(2) == 5);  // 5 ms
  CHECK(lag.waits().at_most(1) == 0);  // 2 ms
}

TEST_CASE("edits of before the start do not count as waiting for the disk", "[server]") {
  DurableLag lag;
  lag.observe(100, 90, 1'000);
  CHECK(lag.lag_us(9'000) == 0);
  lag.observe(101, 90, 2'000);
  CHECK(lag.lag_us(3'000) == 1'000);
  lag.observe(50, 50, 4'000);  // another server's log
  CHECK(lag.lag_us(9'000) == 0);
  CHECK(lag.waits().count() == 0);
}

TEST_CASE("a disk that stands still keeps the memory of the durable lag bounded", "[server]") {
  DurableLag lag;
  lag.observe(0, 0, 0);
  const auto groups = static_cast<Sequence>(3 * DurableLag::kMarksMax);
  for (Sequence seq = 1; seq <= groups; ++seq) lag.observe(seq, 0, static_cast<TimeUs>(seq));
  CHECK(lag.lag_us(static_cast<TimeUs>(groups)) == static_cast<TimeUs>(groups - 1));
  lag.observe(groups, groups - 1, static_cast<TimeUs>(groups));
  // The later groups wait with the last mark.
  CHECK(lag.waits().count() == DurableLag::kMarksMax - 1);
  lag.observe(groups, groups, static_cast<TimeUs>(groups));
  CHECK(lag.waits().count() == groups);
}

}  // namespace runstone::test
