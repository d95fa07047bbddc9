// BackupState: how the backups stand that a server makes by itself, for `status` and the counters.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace runstone {

/// The newest backup of a folder.
struct LastBackup {
  std::string name;             // such as "20261118T033000Z"
  std::uint64_t age_s = 0;      // 0 if its time is after the clock's
  std::uint64_t bytes = 0;      // of its files
  std::uint64_t new_bytes = 0;  // that no earlier backup had
  std::uint64_t ahead_s = 0;    // the seconds by which its time lies after the clock
};

struct BackupState {
  std::optional<LastBackup> last;  // nullopt: there is none, or the folder cannot be read
  std::uint64_t next_s = 0;        // until the next one begins
  bool is_under_way = false;
  std::uint64_t failures = 0;  // since the last backup that was made, or since the start
  std::string failure;         // why the last attempt failed; empty if it did not
};

/// Returns the line of `status`, such as "backups: last 20261118T033000Z, 2 h ago, 120.0 MiB (2.0 MiB new),
/// next in 4 h". A second line says why the last attempt failed.
std::string backup_state_text(const BackupState& state);
/// Returns the fields of the line of counters, such as "backup_age_s=7200 backup_bytes=125829120
/// backup_new_bytes=2097152 backup_next_s=14400 backup_failures=0". Those of the last backup are left
/// out if there is none.
std::string backup_counters(const BackupState& state);

}  // namespace runstone
