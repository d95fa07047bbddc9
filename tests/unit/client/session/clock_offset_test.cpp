#include "client/session/clock_offset.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the shortest round trip gives the offset and its error", "[session]") {
  ClockOffset clock;
  CHECK_FALSE(clock.known());
  CHECK_FALSE(clock.to_local(5).has_value());
  clock.add(1000, 501'500, 2000);  // trip 1000, offset 500000
  CHECK(clock.offset_us() == 500'000);
  CHECK(clock.error_us() == 500);
  clock.add(3000, 503'020, 3100);  // trip 100, offset 499970
  clock.add(4000, 509'000, 9000);  // a slow sample is worse
  CHECK(clock.offset_us() == 499'970);
  CHECK(clock.error_us() == 50);
  CHECK(clock.round_trip_us() == 100);
  CHECK(clock.to_server(10) == 499'980);
  CHECK(clock.to_local(499'980) == 10);
  clock.add(9000, 0, 8000);  // back in time: ignored
  CHECK(clock.offset_us() == 499'970);
  clock.reset();
  CHECK_FALSE(clock.known());
}

TEST_CASE("old samples are dropped, so that drift is followed", "[session]") {
  ClockOffset clock;
  clock.add(0, 1000, 10);
  for (TimeUs i = 1; i <= static_cast<TimeUs>(ClockOffset::kSamples); ++i)
    clock.add(i * 100, i * 100 + 2010, i * 100 + 20);
  CHECK(clock.offset_us() == 2000);
  CHECK(clock.error_us() == 10);
}

TEST_CASE("the true offset lies within the error however the trip is split", "[session]") {
  for (TimeUs there = 0; there <= 100; there += 10) {
    ClockOffset clock;
    const TimeUs truth = 7777;
    clock.add(50, 50 + there + truth, 150);  // 100 in total, `there` on the way to the server
    CHECK(std::abs(clock.offset_us() - truth) <= clock.error_us());
  }
}
