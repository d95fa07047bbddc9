#include "common/core/world_time.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace runstone {

TEST_CASE("the time of a world runs with its rate, over midnight", "[core][world_time]") {
  const WorldTime dusk{21 * 3'600'000, 20};
  CHECK(later(dusk, 0) == dusk);
  CHECK(later(dusk, 60'000'000) == WorldTime{21 * 3'600'000 + 20 * 60'000, 20});
  CHECK(later(dusk, 540'000'000) == WorldTime{0, 20});  // three hours of the world
  CHECK(later({5, 0}, 1'000'000'000) == WorldTime{5, 0});
  CHECK(later(dusk, -1'000'000) == dusk);  // a steady clock of another moment
}

TEST_CASE("a long time at the highest rate stays a time of a day", "[core][world_time]") {
  const WorldTime fast{kDayMs - 1, kTimeRateMax};
  constexpr TimeUs kDayUs = TimeUs{kDayMs} * 1000;
  CHECK(is_valid(later(fast, std::numeric_limits<TimeUs>::max())));
  CHECK(later(fast, 30 * kDayUs) == fast);  // whole days are whole days of the world
  CHECK(later(fast, 30 * kDayUs + 1'000) == WorldTime{9'999, kTimeRateMax});
  CHECK_FALSE(is_valid({kDayMs, 1}));
  CHECK_FALSE(is_valid({0, kTimeRateMax + 1}));
}

TEST_CASE("times of day are read and printed as hours and minutes", "[core][world_time]") {
  CHECK(parse_day_ms("21:05") == 21U * 3'600'000 + 5 * 60'000);
  CHECK(parse_day_ms("0") == 0U);
  CHECK(parse_day_ms("23:59") == kDayMs - 60'000);
  CHECK_FALSE(parse_day_ms("24:00"));
  CHECK_FALSE(parse_day_ms("9:60"));
  for (std::uint32_t minute = 0; minute < 1440; ++minute)
    REQUIRE(parse_day_ms(day_time_text(minute * 60'000 + 59'999)) == minute * 60'000);
  CHECK(day_time_text(kDayMs - 1) == "23:59");
  CHECK(day_share({kDayMs / 4, 0}) == 0.25);
}

}  // namespace runstone
