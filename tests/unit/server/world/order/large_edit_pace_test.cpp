#include "server/world/order/large_edit_pace.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

constexpr TimeUs kSecond = 1'000'000;

TEST_CASE("a pace that rested has room for a burst, and then for its rate", "[world]") {
  LargeEditPace pace;
  TimeUs now_us = 100 * kSecond;
  const std::uint64_t burst = pace.room(now_us);
  CHECK(burst == LargeEditPace::kPerSecond * LargeEditPace::kSavedUsMax / kSecond);
  pace.charge(burst, now_us);
  CHECK(pace.room(now_us) == 0);
  CHECK(pace.room(now_us + 1'000) == LargeEditPace::kPerSecond / 1'000);
  std::uint64_t sent = 0;
  constexpr std::uint64_t kEdit = 100'000;
  for (const TimeUs end_us = now_us + 100 * kSecond; now_us < end_us; now_us += 1'000) {
    if (pace.room(now_us) == 0) continue;
    pace.charge(kEdit, now_us);
    sent += kEdit;
  }
  CHECK(sent >= 100 * LargeEditPace::kPerSecond);
  CHECK(sent <= 100 * LargeEditPace::kPerSecond + kEdit);
}

TEST_CASE("an edit that very many see does not keep others waiting for long", "[world]") {
  LargeEditPace pace;
  pace.charge(1'000 * LargeEditPace::kPerSecond, 5 * kSecond);
  CHECK(pace.room(5 * kSecond) == 0);
  CHECK(pace.room(5 * kSecond + LargeEditPace::kDebtUsMax) == 0);
  CHECK(pace.room(5 * kSecond + LargeEditPace::kDebtUsMax + 1'000) > 0);
}

}  // namespace runstone::test
