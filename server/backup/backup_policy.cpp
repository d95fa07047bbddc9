#include "server/backup/backup_policy.hpp"

#include <algorithm>
#include <cstddef>

namespace runstone {
namespace {

constexpr TimeUs kHourUs = 3'600'000'000, kDayUs = 24 * kHourUs, kWeekUs = 7 * kDayUs;
/// 1970-01-01 was a Thursday, so the Monday before it is three days earlier.
constexpr TimeUs kMondayUs = -3 * kDayUs;

constexpr TimeUs period_of(TimeUs time, TimeUs begin, TimeUs length) {
  const TimeUs since = time - begin;
  return since / length - (since % length < 0 ? 1 : 0);
}

/// Marks the newest time of each of the last `count` periods that have one. `times` ascends.
void mark_newest(const std::vector<TimeUs>& times, TimeUs begin, TimeUs length, std::uint64_t count,
                 std::vector<bool>& stays) {
  for (std::size_t i = times.size(); i > 0 && count > 0; --i) {
    const bool is_newest = i == times.size() || period_of(times[i], begin, length) !=
                                                    period_of(times[i - 1], begin, length);
    if (!is_newest) continue;
    stays[i - 1] = true;
    --count;
  }
}

}  // namespace

std::vector<TimeUs> backups_to_remove(std::vector<TimeUs> times, const BackupPolicy& policy,
                                      TimeUs now_us) {
  std::erase_if(times, [now_us](TimeUs time) { return time > now_us; });
  if (times.empty() || policy.keeps_all()) return {};
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<bool> stays(times.size(), false);
  stays.back() = true;
  mark_newest(times, 0, kHourUs, policy.hourly, stays);
  mark_newest(times, 0, kDayUs, policy.daily, stays);
  mark_newest(times, kMondayUs, kWeekUs, policy.weekly, stays);
  std::vector<TimeUs> removed;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!stays[i]) removed.push_back(times[i]);
  }
  return removed;
}

}  // namespace runstone
