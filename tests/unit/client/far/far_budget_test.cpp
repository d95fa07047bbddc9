#include "client/far/far_budget.hpp"

#include <catch2/catch.hpp>

#include "client/far/far_reach.hpp"

using namespace runstone;

TEST_CASE("a view loses its highest levels while tiles take too much memory", "[far]") {
  FarBudget budget(1'000, 5);
  CHECK_FALSE(budget.step(1'000, true, 0));
  CHECK(budget.step(1'001, false, 1));
  CHECK(budget.step(1'001, false, 2));
  CHECK(budget.levels() == 3);
  CHECK(budget.binds());
}

TEST_CASE("a level comes back after a pause, if it should fit", "[far]") {
  FarBudget budget(1'000, 3);
  REQUIRE(budget.step(1'200, false, 10));
  CHECK_FALSE(budget.step(600, true, 11));
  const TimeUs later = 10 + FarBudget::kGrowPauseUs;
  CHECK_FALSE(budget.step(600, false, later));
  CHECK_FALSE(budget.step(900, true, later));
  CHECK(budget.step(600, true, later));
  CHECK(budget.levels() == 3);
  // The estimate was wrong. The next attempt waits twice as long.
  REQUIRE(budget.step(1'200, true, later + 1));
  CHECK_FALSE(budget.step(600, true, later + 1 + FarBudget::kGrowPauseUs));
  CHECK(budget.step(600, true, later + 1 + 2 * FarBudget::kGrowPauseUs));
}

TEST_CASE("a view without levels gets one again", "[far]") {
  FarBudget budget(100, 1);
  REQUIRE(budget.step(200, false, 0));
  CHECK(budget.levels() == 0);
  CHECK_FALSE(budget.step(200, false, 1));
  CHECK(budget.step(0, true, FarBudget::kGrowPauseUs));
  CHECK_FALSE(budget.binds());
}

TEST_CASE("each level doubles the reach, and those beyond the precision of depth are left out",
          "[far]") {
  View view;
  view.radius_h = 8;
  CHECK(far_reach(view, 32) == 0);
  view.levels = 1;
  CHECK(far_reach(view, 32) == 480);
  view.levels = 6;
  CHECK(far_reach(view, 32) == 15'360);
  view.levels = 8;
  CHECK(far_reach(view, 32) == kReachMax);
  CHECK(useful_levels(8, 32, 8) == 7);
  CHECK(useful_levels(8, 32, 5) == 5);
  CHECK(useful_levels(64, 128, 8) == 2);
}
