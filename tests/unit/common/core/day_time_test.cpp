#include "common/core/day_time.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a time of day is a share of the day", "[core]") {
  CHECK(parse_day_time("0") == 0.0);
  CHECK(parse_day_time("12:00") == 0.5);
  CHECK(parse_day_time("06:30") == Approx(6.5 / 24));
  CHECK(parse_day_time("23:59") == Approx(1439.0 / 1440));
  for (const char* wrong : {"", ":", "24", "12:60", "12:", ":30", "-1", "1:2:3", "012", "1.5"})
    CHECK_FALSE(parse_day_time(wrong).has_value());
}
