#include "server/world/order/world_clock.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("a clock that nobody has set has no time", "[world][world_time]") {
  WorldClock clock(std::nullopt);
  clock.begin(1'000'000);
  CHECK_FALSE(clock.is_set());
  CHECK(clock.at(2'000'000) == std::nullopt);
  CHECK(clock.saved_at(2'000'000) == std::nullopt);
}

TEST_CASE("a clock runs from the record that set it, with the steady clock",
          "[world][world_time]") {
  WorldClock clock(std::nullopt);
  clock.set({3'600'000, 60}, 7, 5'000'000);
  CHECK(clock.record() == 7);
  CHECK(clock.at(6'000'000) == WorldTime{3'660'000, 60});
  CHECK(clock.at(4'000'000) == WorldTime{3'600'000, 60});  // never before it was set
  CHECK(clock.saved_at(6'000'000) == SavedClock{7, {3'660'000, 60}});
}

TEST_CASE("a clock goes on at the next start where it was saved", "[world][world_time]") {
  WorldClock clock(SavedClock{7, {3'660'000, 60}});
  CHECK(clock.at(900'000'000) == WorldTime{3'660'000, 60});  // before it begins
  clock.begin(1'000'000'000);
  clock.begin(2'000'000'000);  // has no effect
  CHECK(clock.at(1'001'000'000) == WorldTime{3'720'000, 60});
  clock.correct({0, 1}, 1'001'000'000);
  CHECK(clock.record() == 7);
  CHECK(clock.at(1'002'000'000) == WorldTime{1'000, 1});
}

}  // namespace runstone::test
