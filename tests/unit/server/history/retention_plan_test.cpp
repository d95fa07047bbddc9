// The plan of a retention: the edits that it would remove.
#include "server/history/retention_plan.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/support/core/temp_folder.hpp"
#include "tests/unit/server/history/retention_world.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kRetentionDay = 24 * kRetentionHour;

struct PlanBench {
  PlanBench() {
    SplitMix64 rng(1);
    make_retention_world(folder.path(), rng, {40});
    store = opened_retention_world(folder.path(), StoreAccess::read_write);
  }
  RetentionPlan plan(std::uint64_t days, TimeUs now_us) const {
    auto planned = plan_retention(*store, days, now_us);
    if (!planned) FAIL(planned.error().message());
    return *std::move(planned);
  }
  const TempFolder folder;
  std::unique_ptr<Store> store;
};

/// A world of records with these times, without snapshots.
std::unique_ptr<Store> world_of(const std::string& folder, std::vector<EditRecord> records) {
  auto store = *create_world(folder, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append({}, records).has_value());
  return store;
}

std::vector<EditRecord> hourly_records(std::size_t count) {
  SplitMix64 rng(2);
  auto records = sample_records(rng, 1, 1, count);
  for (EditRecord& record : records) {
    record.time_us = retention_time(record.version.seq);
    record.cause = Cause::player;
    record.subject = 0;
  }
  return records;
}

}  // namespace

TEST_CASE("the days count back from the newest edit, or from a clock that is behind it",
          "[retention]") {
  const PlanBench bench;
  const TimeUs newest = retention_time(kRetentionEdits);
  // 120 hourly edits: the one that is exactly two days older than the newest goes.
  CHECK(bench.plan(2, newest).cut.version.seq == 72);
  // A clock in the future, such as one that was set wrong, removes no more.
  CHECK(bench.plan(2, newest + 50'000 * kRetentionDay).cut.version.seq == 72);
  CHECK(bench.plan(2, std::numeric_limits<TimeUs>::max()).cut.version.seq == 72);
  CHECK(bench.plan(2, newest - kRetentionDay).cut.version.seq == 48);
  CHECK(bench.plan(2, 0).removes_nothing());
  CHECK(bench.plan(2, std::numeric_limits<TimeUs>::min()).removes_nothing());
  CHECK(bench.plan(5, newest).removes_nothing());
  CHECK(bench.plan(kRetentionDaysMax, newest).removes_nothing());
}

TEST_CASE("a plan counts what would go", "[retention]") {
  const PlanBench bench;
  const RetentionPlan plan = bench.plan(2, retention_time(kRetentionEdits));
  CHECK(plan.volume.edits == 72);
  CHECK(plan.volume.keyframes == 1);
  CHECK(plan.volume.log_bytes > 72 * 82);
  CHECK(plan.volume.keyframe_bytes > 0);
  CHECK(plan.volume.base_bytes_max > 0);
  std::uint64_t rights = 0;
  for (const auto& [cause, edits] : plan.volume.causes) {
    if (cause == Cause::rights) rights = edits;
  }
  CHECK(rights == 4);  // 17, 34, 51, 68
  CHECK(plan.head == LogEnd{});
  CHECK(plan.cut.time_us == retention_time(72));
  CHECK(plan.newest.version.seq == kRetentionEdits);
  CHECK(plan.doubt.empty());
}

TEST_CASE("a policy that would keep no day is refused", "[retention]") {
  const PlanBench bench;
  const auto none = plan_retention(*bench.store, 0, retention_time(200));
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error().what.find("0 days would keep no edit") == 0);
  CHECK(plan_retention(*bench.store, kRetentionDaysMax + 1, 0).error().what ==
        "at most 36500 days can be kept");
}

TEST_CASE("an empty log has nothing to remove", "[retention]") {
  const TempFolder folder;
  const auto store = *create_world(folder.path(), sample_meta());
  const auto plan = plan_retention(*store, 1, retention_time(5));
  REQUIRE(plan.has_value());
  CHECK(plan->removes_nothing());
}

TEST_CASE("a step of the time that is as long as the policy waits for a person", "[retention]") {
  auto records = hourly_records(20);
  for (std::size_t i = 10; i < 20; ++i) records[i].time_us += 400 * kRetentionDay;
  const TempFolder folder;
  const auto store = world_of(folder.path(), records);
  const auto plan = plan_retention(*store, 30, records.back().time_us);
  REQUIRE(plan.has_value());
  CHECK(plan->cut.version.seq == 10);
  CHECK(plan->doubt ==
        "the time of the log steps ahead by 400 days, from seq=10 (2023-11-15T08:13:20Z) to "
        "2024-12-19T09:13:20Z: nobody built for so long, or the clock of the machine was wrong");
  CHECK(plan_retention(*store, 500, records.back().time_us)->removes_nothing());
}

TEST_CASE("a step of the time inside of an action waits for a person, too", "[retention]") {
  auto records = hourly_records(20);
  for (std::size_t i = 10; i < 20; ++i) records[i].time_us += 400 * kRetentionDay;
  records[10].subject = 8;  // 11 belongs to the action that began with 8, before the step
  const TempFolder folder;
  const auto store = world_of(folder.path(), records);
  const auto plan = plan_retention(*store, 30, records.back().time_us);
  REQUIRE(plan.has_value());
  CHECK(plan->cut.version.seq == 7);
  CHECK(plan->doubt.find("the time of the log steps ahead by 400 days, from seq=10 ") == 0);
}

TEST_CASE("edits that a wrong clock dated into the future stay until their era is old",
          "[retention][clock]") {
  auto records = hourly_records(60);
  // 20 to 29 by a clock that is years ahead. 30 corrects the time.
  for (std::size_t i = 19; i < 29; ++i) records[i].time_us += 2'000 * kRetentionDay;
  records[29].cause = Cause::rights;
  records[29].edit = rights_edit(CorrectTime{-2'000 * kRetentionDay, 20});
  const TempFolder folder;
  const auto store = world_of(folder.path(), records);
  // A day before the newest edit lies behind the correction. All edits before are removed, and
  // there is no doubt.
  const auto plan = plan_retention(*store, 1, records.back().time_us);
  REQUIRE(plan.has_value());
  CHECK(plan->cut.version.seq == 36);
  CHECK(plan->doubt.empty());
  // Two days before the newest edit lie before the edits of the wrong clock.
  const auto longer = plan_retention(*store, 2, records.back().time_us);
  REQUIRE(longer.has_value());
  CHECK(longer->cut.version.seq == 12);
  CHECK(store->check().has_value());
}

TEST_CASE("a cut does not divide an action", "[retention]") {
  auto records = hourly_records(80);
  // One action has the edits 50, 56 and 58, another one 48 and 51.
  for (const std::size_t i : {55U, 57U}) records[i].subject = 50;
  records[50].subject = 48;
  const TempFolder folder;
  const auto store = world_of(folder.path(), records);
  // Two days before the newest edit, 80, is edit 32.
  CHECK(plan_retention(*store, 2, records.back().time_us)->cut.version.seq == 32);
  // A day before is 56. 58 belongs to the action that began with 50, and 51 to that of 48.
  CHECK(plan_retention(*store, 1, records.back().time_us)->cut.version.seq == 47);
}

}  // namespace runstone::test
