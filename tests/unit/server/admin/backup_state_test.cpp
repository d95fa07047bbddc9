// How the state of the backups is shown.
#include "server/admin/backup_state.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("the state of the backups says when the last one was and when the next one is",
          "[admin][backup]") {
  BackupState state;
  state.next_s = 45;
  CHECK(backup_state_text(state) == "backups: none yet, next in 45 s");
  CHECK(backup_counters(state) == "backup_next_s=45 backup_failures=0");
  state.last = LastBackup{"20261118T110640Z", 7'260, 125'829'120, 2'097'152};
  state.next_s = 3 * 86'400;
  CHECK(backup_state_text(state) ==
        "backups: last 20261118T110640Z, 2 h ago, 120.0 MiB (2.0 MiB new), next in 3 days");
  CHECK(backup_counters(state) ==
        "backup_age_s=7260 backup_bytes=125829120 backup_new_bytes=2097152 backup_next_s=259200 "
        "backup_failures=0");
  state.is_under_way = true;
  state.failures = 2;
  state.failure = "/b: is no folder: make it, or mount its disk";
  CHECK(backup_state_text(state) ==
        "backups: last 20261118T110640Z, 2 h ago, 120.0 MiB (2.0 MiB new), one is under way\n"
        "BACKUPS FAIL, 2 times: /b: is no folder: make it, or mount its disk");
}

TEST_CASE("the state of the backups says that the newest one is dated in the future",
          "[admin][backup]") {
  BackupState state;
  state.last = LastBackup{"20361118T110640Z", 0, 1'024, 0};
  state.last->ahead_s = 7'200;
  const std::string text = backup_state_text(state);
  CHECK(text.starts_with("backups: last 20361118T110640Z, dated 2 h in the future, "));
  CHECK(text.find("\nBACKUPS: the last one is dated in the future: ") != std::string::npos);
  state.last->ahead_s = 0;
  CHECK(backup_state_text(state).find("future") == std::string::npos);
}

}  // namespace runstone::test
