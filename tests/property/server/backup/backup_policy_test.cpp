// Which backups a policy removes, for random times and policies.
#include "server/backup/backup_policy.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <set>
#include <string>

#include "common/core/hash.hpp"
#include "common/core/utc_text.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kHour = 3'600'000'000, kDay = 24 * kHour;
constexpr TimeUs kNow = 1'795'000'000'000'000;  // 2026-11-18

std::string hour_of(TimeUs time) { return utc_text(time).substr(0, 13); }
std::string day_of(TimeUs time) { return utc_text(time).substr(0, 10); }
/// The date of the Monday of the week, by the calendar of the standard library.
std::string week_of(TimeUs time) {
  using namespace std::chrono;
  const sys_days day = floor<days>(sys_time<microseconds>(microseconds(time)));
  const sys_days monday = day - (weekday(day) - Monday);
  return day_of(duration_cast<microseconds>(monday.time_since_epoch()).count());
}

/// Returns true if a time is the newest one of its period, and fewer than `count` later periods have a
/// time.
template <class PeriodOf>
bool stays_by(const std::set<TimeUs>& times, TimeUs time, std::uint64_t count,
              const PeriodOf& period_of) {
  std::set<std::string> later;
  for (const TimeUs other : times) {
    if (other <= time) continue;
    if (period_of(other) == period_of(time)) return false;
    later.insert(period_of(other));
  }
  return later.size() < count;
}

std::vector<TimeUs> random_times(SplitMix64& rng) {
  std::vector<TimeUs> times;
  const std::uint32_t count = rng.below(120);
  TimeUs time = kNow - static_cast<TimeUs>(rng.below(400)) * kDay;
  for (std::uint32_t i = 0; i < count; ++i) {
    const TimeUs steps[] = {0, 1'000'000, kHour / 7, kHour, 5 * kHour, kDay, 9 * kDay};
    time += steps[rng.below(7)] + (rng.below(2) == 0 ? 0 : rng.below(1'000'000));
    times.push_back(time);
  }
  for (std::size_t i = times.size(); i > 1; --i)
    std::swap(times[i - 1], times[rng.below(static_cast<std::uint32_t>(i))]);
  return times;
}

}  // namespace

TEST_CASE("a policy keeps the newest backup of each of the last hours, days and weeks",
          "[backup][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  for (int round = 0; round < 300; ++round) {
    const std::vector<TimeUs> times = random_times(rng);
    const BackupPolicy policy{rng.below(30), rng.below(12), rng.below(6)};
    CAPTURE(round, times.size(), policy.hourly, policy.daily, policy.weekly);
    // Some times may be after the clock, which was ahead.
    const TimeUs now = kNow - static_cast<TimeUs>(rng.below(200)) * kDay;
    const std::vector<TimeUs> removed = backups_to_remove(times, policy, now);
    REQUIRE(std::is_sorted(removed.begin(), removed.end()));
    std::set<TimeUs> all(times.begin(), times.end());
    all.erase(all.upper_bound(now), all.end());
    const std::set<TimeUs> gone(removed.begin(), removed.end());
    REQUIRE(gone.size() == removed.size());
    std::vector<TimeUs> left;
    for (const TimeUs time : all) {
      CAPTURE(utc_text(time));
      const bool stays = policy.keeps_all() || time == *all.rbegin() ||
                         stays_by(all, time, policy.hourly, hour_of) ||
                         stays_by(all, time, policy.daily, day_of) ||
                         stays_by(all, time, policy.weekly, week_of);
      REQUIRE(gone.contains(time) != stays);
      if (stays) left.push_back(time);
    }
    REQUIRE(gone.size() + left.size() == all.size());
    REQUIRE((all.empty() || !left.empty()));
    CHECK(backups_to_remove(left, policy, now).empty());
  }
}

TEST_CASE("backups of every hour that are pruned each time cover days and weeks", "[backup]") {
  const BackupPolicy policy{24, 7, 4};
  std::vector<TimeUs> kept;
  TimeUs now = kNow;
  for (int hour = 0; hour < 24 * 60; ++hour) {
    now = kNow + hour * kHour;
    kept.push_back(now);
    const auto removed = backups_to_remove(kept, policy, now);
    for (const TimeUs time : removed) std::erase(kept, time);
    REQUIRE(kept.back() == now);
    REQUIRE(kept.size() <= 24 + 7 + 4);
  }
  std::set<std::string> hours, days, weeks;
  for (const TimeUs time : kept) {
    hours.insert(hour_of(time));
    days.insert(day_of(time));
    weeks.insert(week_of(time));
  }
  for (int i = 0; i < 24; ++i) CHECK(hours.contains(hour_of(now - i * kHour)));
  for (int i = 0; i < 7; ++i) CHECK(days.contains(day_of(now - i * kDay)));
  for (int i = 0; i < 4; ++i) CHECK(weeks.contains(week_of(now - i * 7 * kDay)));
}

TEST_CASE("a policy without numbers keeps every backup, and one backup always stays", "[backup]") {
  CHECK(backups_to_remove({1, 2, 3}, {0, 0, 0}, 9).empty());
  CHECK(backups_to_remove({}, {1, 1, 1}, 9).empty());
  CHECK(backups_to_remove({5}, {0, 1, 0}, 9).empty());
  CHECK(backups_to_remove({3, 1, 2}, {1, 0, 0}, 9) == std::vector<TimeUs>{1, 2});
  CHECK(backups_to_remove({3, 1, 2}, {1, 0, 0}, 2) == std::vector<TimeUs>{1});
  CHECK(backups_to_remove({3, 1, 2}, {1, 0, 0}, 0).empty());
}

}  // namespace runstone::test
