// BackupPolicy: which backups of a folder stay, and which are removed.
// Threads: any. The functions read no clock.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

/// The newest backup of each of the last `hourly` hours stays, and so does that of each of the last
/// `daily` days and `weekly` weeks. Only hours, days and weeks that have a backup count. They are
/// those of UTC, and a week begins on Monday. If all three are 0, every backup stays.
struct BackupPolicy {
  std::uint64_t hourly = 24;
  std::uint64_t daily = 7;
  std::uint64_t weekly = 8;

  bool keeps_all() const { return hourly == 0 && daily == 0 && weekly == 0; }
  friend bool operator==(const BackupPolicy&, const BackupPolicy&) = default;
};

/// Returns the times among `times` (UTC) whose backups the policy removes, in ascending order. The
/// newest one that is not after `now_us` is never among them. Times after `now_us` are of a clock
/// that was wrong: they are not among them either, and take no place of another backup. Cost: O(n
/// log n).
std::vector<TimeUs> backups_to_remove(std::vector<TimeUs> times, const BackupPolicy& policy,
                                      TimeUs now_us);

}  // namespace runstone
