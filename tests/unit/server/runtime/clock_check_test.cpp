#include "server/runtime/clock_check.hpp"

#include <catch2/catch.hpp>

#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kDay = TimeUs{24} * 3600 * 1'000'000;
constexpr TimeUs kNow = 20'000 * kDay;

ClockEvidence evidence(TimeUs last_us, TimeUs written_us, std::optional<bool> is_synchronised) {
  return {kNow, last_us, written_us, "w/world.sqlite", is_synchronised};
}

}  // namespace

TEST_CASE("a wall clock near the newest time of the world is trusted", "[server][clock]") {
  for (const auto is_synchronised :
       {std::optional<bool>(), std::optional(true), std::optional(false)}) {
    for (const TimeUs age_us : {TimeUs{0}, kDay, kRestUs}) {
      const ClockCheck check = check_clock(evidence(kNow - age_us, 0, is_synchronised));
      CHECK_FALSE(check.warning.has_value());
      CHECK_FALSE(check.begin_us.has_value());
    }
    // A world that was served until yesterday may have had no edit for a year.
    CHECK_FALSE(check_clock(evidence(kNow - 365 * kDay, kNow - kDay, is_synchronised)).warning);
    CHECK_FALSE(check_clock(evidence(0, 0, is_synchronised)).warning);  // a new world
  }
}

TEST_CASE("a wall clock far ahead of the world is doubted unless a time service has set it",
          "[server][clock]") {
  const TimeUs last = kNow - 400 * kDay, written = kNow - 300 * kDay;
  CHECK_FALSE(check_clock(evidence(last, written, true)).warning.has_value());
  const ClockCheck unknown = check_clock(evidence(last, written, std::nullopt));
  CHECK(unknown.warning.has_value());
  CHECK_FALSE(unknown.begin_us.has_value());
  const ClockCheck unset = check_clock(evidence(last, written, false));
  CHECK(unset.begin_us == written);
  REQUIRE(unset.warning.has_value());
  CHECK(unset.warning->find("clock correct anyway") != std::string::npos);
}

TEST_CASE("a wall clock behind a file of the world makes a warning that names the file",
          "[server][clock]") {
  const auto warning = check_clock(evidence(kNow - kDay, kNow + kDay, true)).warning;
  REQUIRE(warning.has_value());
  CHECK(warning->find("w/world.sqlite was written at 2024-10-05T00:00:00Z") != std::string::npos);
  // LogClock warns of a log that ends ahead.
  CHECK_FALSE(check_clock(evidence(kNow + kDay, kNow + kDay, true)).warning.has_value());
  CHECK_FALSE(check_clock(evidence(0, kNow + 1'000'000, true)).warning.has_value());
}

TEST_CASE("a wall clock behind the log is doubted unless a time service has set it",
          "[server][clock]") {
  const TimeUs last = kNow + 400 * kDay;
  CHECK_FALSE(doubt_of_clock_behind(evidence(last, kNow + kDay, true)).has_value());
  CHECK(doubt_of_clock_behind(evidence(last, kNow - kDay, false)) == "no time service has set it");
  CHECK_FALSE(doubt_of_clock_behind(evidence(last, kNow - kDay, std::nullopt)).has_value());
  CHECK(doubt_of_clock_behind(evidence(last, kNow + kDay, std::nullopt)) ==
        "it is behind the time at which w/world.sqlite was written, 2024-10-05T00:00:00Z");
}

TEST_CASE("the times of a world's files are read", "[server][clock]") {
  const TempFolder folder;
  REQUIRE(create_world(folder / "w", sample_meta()).has_value());
  const ClockEvidence read = read_clock_evidence(folder / "w", 5);
  CHECK(read.last_us == 5);
  CHECK(read.file.find("/w/world.") != std::string::npos);
  CHECK(read.wall_us - read.written_us < kDay);
  CHECK_FALSE(check_clock(read).warning.has_value());
  CHECK(read_clock_evidence(folder / "absent", 5).written_us == 0);
}

}  // namespace runstone::test
