#include "server/world/order/log_clock.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>

namespace runstone {
namespace {

constexpr TimeUs kSecond = 1'000'000;
constexpr TimeUs kMinute = 60 * kSecond;
constexpr TimeUs kYear = 365 * 24 * 60 * kMinute;
constexpr TimeUs kStart = 1'700'000'000 * kSecond;

/// Both clocks of a machine. `wrong_us` is what the wall clock is ahead of the right time.
struct ClockPair {
  LogClock log;
  TimeUs steady_us = 5 * kSecond;
  TimeUs wrong_us = 0;

  explicit ClockPair(TimeUs last_us = 0) : log(last_us) { log.advance(now()); }
  Clocks now() const { return {steady_us, right() + wrong_us}; }
  TimeUs right() const { return kStart + steady_us; }
  void pass(TimeUs us, TimeUs step_us = 50'000) {
    for (const TimeUs end_us = steady_us + us; steady_us < end_us;) {
      steady_us += step_us;
      log.advance(now());
      if (log.is_step_due()) log.accept_wall_clock();
    }
  }
};

TEST_CASE("the time of the log is the wall clock's, and advances with it", "[world]") {
  ClockPair clocks;
  CHECK(clocks.log.stamp() == clocks.right());
  clocks.pass(3 * kMinute);
  CHECK(clocks.log.stamp() == clocks.right());
  CHECK_FALSE(clocks.log.take_warning().has_value());
}

TEST_CASE("clocks that were read before the last call move nothing", "[world]") {
  ClockPair clocks;
  const Clocks early = clocks.now();
  clocks.pass(kMinute);
  for (int i = 0; i < 10; ++i) {
    clocks.log.advance(early);
    clocks.log.advance(clocks.now());
  }
  CHECK(clocks.log.stamp() == clocks.right());
  CHECK_FALSE(clocks.log.take_warning().has_value());
}

TEST_CASE("a wall clock that is three years ahead for a minute stamps no edit with its time",
          "[world]") {
  ClockPair clocks;
  clocks.wrong_us = 3 * kYear;
  clocks.pass(kMinute);
  CHECK(clocks.log.stamp() == clocks.right());
  const auto warning = clocks.log.take_warning();
  REQUIRE(warning.has_value());
  CHECK(warning->find("2026-11-13T22:13:25Z, the time of the log is 2023-11-14T22:13:25Z") !=
        std::string::npos);
  CHECK_FALSE(clocks.log.take_warning().has_value());  // one warning for one jump
  clocks.wrong_us = 0;
  clocks.pass(kMinute);
  CHECK(clocks.log.stamp() == clocks.right());
  CHECK(clocks.log.take_warning() == "the wall clock agrees with the time of the log again");
}

TEST_CASE("a jump of the wall clock is taken over once it was kept for an hour", "[world]") {
  ClockPair clocks;
  const TimeUs before_us = clocks.log.stamp();
  SECTION("ahead") {
    clocks.wrong_us = 5 * kMinute;
    clocks.pass(LogClock::kAcceptUs, kSecond);
    CHECK(clocks.log.stamp() == clocks.right());
    clocks.pass(kSecond);
    CHECK(clocks.log.stamp() == clocks.right() + 5 * kMinute);
  }
  SECTION("back, and no time decreases") {
    clocks.wrong_us = -2 * LogClock::kAcceptUs;
    clocks.pass(LogClock::kAcceptUs, kSecond);
    const TimeUs last_us = clocks.log.stamp();
    CHECK(last_us == before_us + LogClock::kAcceptUs);
    clocks.pass(LogClock::kAcceptUs, kSecond);
    CHECK(clocks.log.stamp() == last_us);  // the wall clock has not reached it
    clocks.pass(2 * LogClock::kAcceptUs, kSecond);
    CHECK(clocks.log.stamp() == clocks.right() + clocks.wrong_us);
  }
  SECTION("but not one that changes again within the hour") {
    for (int i = 1; i <= 4; ++i) {
      clocks.wrong_us = i * kYear;
      clocks.pass(LogClock::kAcceptUs / 2, kSecond);
      CHECK(clocks.log.take_warning().has_value());
    }
    CHECK(clocks.log.stamp() == clocks.right());
  }
}

TEST_CASE("a small error of the wall clock is slewed by 500 ppm, whatever the steps", "[world]") {
  const TimeUs step_us = GENERATE(TimeUs{100}, TimeUs{50'000}, 100 * kSecond);
  ClockPair clocks;
  clocks.wrong_us = 40'000;
  clocks.pass(100 * kSecond, step_us);
  // A step of 100 us allows a slew of 0.05 us. These must add up.
  CHECK(clocks.log.stamp() == clocks.right() + 40'000);
  clocks.wrong_us = -1 * kSecond;
  const TimeUs error_us = clocks.log.stamp() - clocks.right();
  clocks.pass(100 * kSecond, step_us);
  CHECK(clocks.log.stamp() - clocks.right() == error_us - 50'000);
  CHECK_FALSE(clocks.log.take_warning().has_value());
}

TEST_CASE("small jumps that add up to more than a minute are reported", "[world]") {
  ClockPair clocks;
  clocks.wrong_us = 50 * kSecond;
  clocks.pass(kSecond);
  CHECK_FALSE(clocks.log.take_warning().has_value());
  clocks.wrong_us = 100 * kSecond;
  clocks.pass(kSecond);
  CHECK(clocks.log.take_warning().has_value());
}

TEST_CASE("a log that ends ahead of the wall clock is reported, and keeps its time until then",
          "[world]") {
  ClockPair ahead(kStart + 3 * kMinute);
  const auto warning = ahead.log.take_warning();
  REQUIRE(warning.has_value());
  CHECK(warning->find("ends at 2023-11-14T22:16:20Z, but the wall clock reads "
                      "2023-11-14T22:13:25Z") != std::string::npos);
  ahead.pass(kMinute);
  CHECK(ahead.log.stamp() == kStart + 3 * kMinute);
  ahead.pass(2 * kMinute);
  CHECK(ahead.log.stamp() == ahead.right());
  ClockPair little(kStart + kMinute);
  CHECK_FALSE(little.log.take_warning().has_value());
}

TEST_CASE("the time by which restrictions end advances although the log ends years ahead",
          "[world]") {
  ClockPair clocks(kStart + 2 * kYear);
  const TimeUs begin_us = clocks.log.time();
  CHECK(begin_us == kStart + 2 * kYear);
  clocks.pass(5 * kSecond);
  CHECK(clocks.log.time() == begin_us + 5 * kSecond);
  CHECK(clocks.log.stamp() == kStart + 2 * kYear);
  // The clock is set right, to a time that is nearer to the end of the log, and time() never goes back.
  clocks.wrong_us = kYear;
  TimeUs before_us = clocks.log.time();
  for (int minute = 0; minute < 70; ++minute) {
    clocks.pass(kMinute, kSecond);
    CHECK(clocks.log.time() == before_us + kMinute);
    before_us = clocks.log.time();
  }
}

TEST_CASE("restrictions end also at a server that took over from one whose clock is ahead",
          "[world]") {
  ClockPair clocks;
  clocks.pass(kMinute);
  clocks.log.note_ordered(kStart + 2 * kYear);
  const TimeUs begin_us = clocks.log.time();
  CHECK(begin_us == kStart + 2 * kYear);
  clocks.pass(5 * kSecond);
  CHECK(clocks.log.time() == begin_us + 5 * kSecond);
}

TEST_CASE("a correction makes the time of the log the wall clock's, and edits go on from there",
          "[world][clock]") {
  ClockPair clocks(kStart + 2 * kYear);
  clocks.pass(5 * kSecond);
  CHECK(clocks.log.time() - clocks.log.wall_us() > kYear);
  clocks.log.accept_wall_clock();
  CHECK(clocks.log.stamp() == clocks.right());
  CHECK(clocks.log.time() == clocks.right());
  clocks.pass(kMinute);
  CHECK(clocks.log.stamp() == clocks.right());
}

TEST_CASE("a correction takes over a jump that is not kept for long yet", "[world][clock]") {
  ClockPair clocks;
  clocks.wrong_us = GENERATE(-2 * kYear, 2 * kYear);
  clocks.pass(kMinute);
  CHECK(clocks.log.has_jumped());
  CHECK(clocks.log.stamp() == clocks.right());
  clocks.log.accept_wall_clock();
  CHECK_FALSE(clocks.log.has_jumped());
  clocks.pass(kMinute);
  CHECK(clocks.log.stamp() == clocks.right() + clocks.wrong_us);
  CHECK(clocks.log.time() == clocks.right() + clocks.wrong_us);
}

TEST_CASE("a server that follows takes a correction, also if its own clock is as wrong",
          "[world][clock]") {
  ClockPair clocks;
  clocks.wrong_us = GENERATE(TimeUs{0}, 2 * kYear);
  clocks.log = LogClock(0);
  clocks.log.advance(clocks.now());
  clocks.log.note_ordered(clocks.right() + 2 * kYear);
  CHECK(clocks.log.time() >= clocks.right() + 2 * kYear);
  clocks.log.note_ordered(clocks.right(), true);
  CHECK(clocks.log.time() == clocks.right());
  clocks.log.note_ordered(clocks.right() + kSecond);
  clocks.pass(kMinute);
  CHECK(std::abs(clocks.log.time() - clocks.right()) <= kSecond);
}

TEST_CASE("the time does not step ahead by itself, because restrictions would end at once",
          "[world][clock]") {
  ClockPair clocks;
  clocks.wrong_us = kYear;
  for (int minute = 0; minute < 90; ++minute) {
    clocks.steady_us += kMinute;
    clocks.log.advance(clocks.now());
    CHECK(clocks.log.time() == clocks.right());
    CHECK(clocks.log.is_step_due() == (minute >= 60));
    CHECK(clocks.log.has_jumped() == (minute < 60));
  }
  CHECK(clocks.log.ahead_us() == -kYear);
  clocks.log.accept_wall_clock();
  CHECK_FALSE(clocks.log.is_step_due());
  CHECK(clocks.log.time() == clocks.right() + kYear);
}

TEST_CASE("a server with a wrong clock goes on from the time of the former owner",
          "[world][clock]") {
  ClockPair clocks;
  clocks.wrong_us = 2 * kYear;
  clocks.log = LogClock(kStart);
  clocks.log.advance(clocks.now());
  clocks.pass(kMinute);
  SECTION("that it has heard") {
    clocks.log.note_ordered(clocks.right());
    clocks.log.hear_owner(clocks.right(), clocks.now());
    clocks.pass(2 * kMinute);
    static_cast<void>(clocks.log.take_warning());
    clocks.log.take_over(clocks.now());
    CHECK(clocks.log.has_jumped());
    CHECK(clocks.log.take_warning().value_or("").starts_with("the wall clock has jumped"));
    CHECK(clocks.log.stamp() == clocks.right());
    CHECK(clocks.log.time() == clocks.right());
    clocks.pass(LogClock::kAcceptUs / 2, kSecond);
    CHECK(clocks.log.time() == clocks.right());
    clocks.wrong_us = 0;
    clocks.pass(kSecond);
    CHECK_FALSE(clocks.log.has_jumped());
  }
  SECTION("but not from records that it has read, which may be old") {
    clocks.log.note_ordered(clocks.right() - kYear);
    clocks.log.take_over(clocks.now());
    CHECK(clocks.log.stamp() == clocks.right() + 2 * kYear);
  }
  SECTION("and says so if it is behind") {
    clocks.log.note_ordered(clocks.right() + 3 * kYear);
    clocks.log.hear_owner(clocks.right() + 3 * kYear, clocks.now());
    clocks.log.take_over(clocks.now());
    CHECK(clocks.log.take_warning().value_or("").starts_with("the log ends at "));
  }
}

TEST_CASE("records may have any time", "[world][clock]") {
  constexpr TimeUs kFirst = std::numeric_limits<TimeUs>::min();
  constexpr TimeUs kLast = std::numeric_limits<TimeUs>::max();
  const TimeUs end_us = GENERATE_COPY(TimeUs{kFirst}, kFirst + 1, kLast - 1, TimeUs{kLast});
  ClockPair clocks(end_us);
  clocks.pass(kMinute);
  CHECK(clocks.log.stamp() == std::max(end_us, clocks.right()));
  CHECK(clocks.log.time() >= clocks.right());
  clocks.log.note_ordered(kLast);
  clocks.log.hear_owner(kLast, clocks.now());
  clocks.log.note_ordered(kFirst, true);
  clocks.pass(kMinute);
  clocks.log.hear_owner(kFirst, clocks.now());
  clocks.log.take_over(clocks.now());
  clocks.pass(kMinute);
  clocks.log.accept_wall_clock();
  CHECK(clocks.log.stamp() == clocks.right());
}

TEST_CASE("a log whose start doubts the wall clock goes on from its own time for an hour",
          "[world][clock]") {
  ClockPair clocks;
  clocks.wrong_us = 2 * kYear;
  clocks.log = LogClock(kStart - kMinute, kStart);
  clocks.log.advance(clocks.now());
  CHECK(clocks.log.stamp() == kStart);
  CHECK(clocks.log.has_jumped());
  SECTION("and follows if it stays so") {
    clocks.pass(LogClock::kAcceptUs + kSecond, kSecond);
    CHECK(clocks.log.stamp() == clocks.right() + 2 * kYear);
  }
  SECTION("and does not if a time service sets it right") {
    clocks.pass(kMinute, kSecond);
    clocks.wrong_us = 0;
    clocks.pass(LogClock::kAcceptUs + kMinute, kSecond);
    CHECK(std::abs(clocks.log.stamp() - clocks.right()) < kMinute);
  }
}

}  // namespace
}  // namespace runstone
