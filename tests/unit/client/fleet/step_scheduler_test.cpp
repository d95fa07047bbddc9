#include "client/fleet/step_scheduler.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("steps are taken in the order of their times, once they are due", "[fleet]") {
  StepScheduler scheduler;
  CHECK_FALSE(scheduler.next_us().has_value());
  scheduler.add(0, 300);
  scheduler.add(1, 100);
  scheduler.add(2, 200);
  CHECK(scheduler.next_us() == 100);
  CHECK_FALSE(scheduler.take(99).has_value());
  CHECK(scheduler.take(250)->bot == 1);
  CHECK(scheduler.take(250)->bot == 2);
  CHECK_FALSE(scheduler.take(250).has_value());
  CHECK(scheduler.next_us() == 300);
}

TEST_CASE("steps that are brought forward are due at once, and overdue ones keep their time",
          "[fleet]") {
  StepScheduler scheduler;
  scheduler.add(0, 900);
  scheduler.add(1, 50);
  scheduler.bring_forward(100);
  const auto first = scheduler.take(100);
  REQUIRE(first.has_value());
  CHECK(first->bot == 1);
  CHECK(first->due_us == 50);
  const auto second = scheduler.take(100);
  REQUIRE(second.has_value());
  CHECK(second->bot == 0);
  CHECK(second->due_us == 100);
}
