#include "common/core/utc_text.hpp"

#include <catch2/catch.hpp>

namespace runstone {

TEST_CASE("times are written and read by the calendar, in UTC", "[core]") {
  CHECK(utc_text(0) == "1970-01-01T00:00:00Z");
  CHECK(utc_text(1'000'000'000'999'999) == "2001-09-09T01:46:40Z");
  CHECK(utc_text(1'795'000'000'000'000) == "2026-11-18T11:06:40Z");
  CHECK(utc_text(951'782'400'000'000) == "2000-02-29T00:00:00Z");
  CHECK(utc_text(-1) == "1969-12-31T23:59:59Z");
  CHECK(parse_utc("2001-09-09T01:46:40Z") == 1'000'000'000'000'000);
  CHECK(parse_utc("2001-09-09T01:46:40") == 1'000'000'000'000'000);
  CHECK(parse_utc("2001-09-09T01:46") == 999'999'960'000'000);
  CHECK(parse_utc("2001-09-09") == 999'993'600'000'000);
  CHECK(parse_utc("2400-02-29").has_value());
  CHECK(parse_utc("2001-09-09T01:46:40.5Z") == 1'000'000'000'500'000);
  CHECK(parse_utc("2001-09-09T01:46:40.000001") == 1'000'000'000'000'001);
  CHECK(parse_utc("9999-12-31T23:59:59.999999Z") == 253'402'300'799'999'999);
}

TEST_CASE("every second of a day and days over centuries round trip", "[core]") {
  for (TimeUs us = 0; us < 86'400'000'000; us += 7'000'000) REQUIRE(parse_utc(utc_text(us)) == us);
  for (TimeUs day = 0; day < 200'000; day += 13) {
    REQUIRE(parse_utc(utc_text(day * 86'400'000'000)) == day * 86'400'000'000);
  }
}

TEST_CASE("text that is no time and no duration is rejected", "[core]") {
  for (const char* text : {"",
                           "2001",
                           "2001-9-09",
                           "2001-02-29",
                           "2001-13-01",
                           "2001-00-01",
                           "2001-01-00",
                           "2001-01-32",
                           "1969-12-31",
                           "2001-09-09T",
                           "2001-09-09T24:00",
                           "2001-09-09T01:60",
                           "2001-09-09T01:46:60",
                           "2001-09-09T01:46:",
                           "2001-09-09 01:46",
                           "2001-09-09T01:46Zx",
                           "2001-09-09T01:46.5Z",
                           "2001-09-09T01:46:40.Z",
                           "2001-09-09T01:46:40.1234567Z",
                           "2001-09-09T01:46:40.-1Z",
                           "2001-09-09T01:46:40+01:00",
                           "2001-09-09Z",
                           "2001-09-09T0146",
                           "-001-01-01"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_utc(text).has_value());
  }
  CHECK(parse_duration("90s") == 90'000'000);
  CHECK(parse_duration("15m") == 900'000'000);
  CHECK(parse_duration("1h") == 3'600'000'000);
  CHECK(parse_duration("2d") == 172'800'000'000);
  CHECK(parse_duration("999999w").has_value());
  CHECK(parse_duration("0s") == 0);
  CHECK(parse_duration("2h30m") == 9'000'000'000);
  CHECK(parse_duration("1w2d3h4m5s") == 788'645'000'000);
  CHECK(parse_duration("999999w999999d999999h999999m999999s") == 694'860'305'139'000'000);
  for (const char* text : {"", "h", "1", "1x", "-1h", "1.5h", "1hh", "1000000s", " 1h", "30m2h",
                           "2h2h", "2h30", "2h 30m", "2h-30m"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_duration(text).has_value());
  }
}

}  // namespace runstone
