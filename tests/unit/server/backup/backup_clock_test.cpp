// Backups in a backup folder whose clock was wrong: which one is the newest, and which are removed.
#include <catch2/catch.hpp>

#include "tests/unit/server/backup/folder_bench.hpp"

namespace runstone::test {
namespace {

using Catch::Matchers::Contains;
constexpr int kAhead = 12 * 24;  // hours

}  // namespace

TEST_CASE_METHOD(FolderBench, "backups dated in the future remove no backup of now", "[backup]") {
  REQUIRE(add(kAhead, {2, 0, 0}) == "");
  play(10);
  REQUIRE(add(kAhead + 1, {2, 0, 0}) == "");
  for (int hour = 0; hour < 4; ++hour) {
    play(10);
    REQUIRE(add(hour, {2, 0, 0}) == "");
    CAPTURE(hour);
    std::vector<std::string> names;
    for (const auto& entry : entries()) names.push_back(entry.name);
    std::vector<std::string> expected;
    if (hour > 0) expected.push_back(backup_name(kBackupTimeUs + (hour - 1) * kBackupHourUs));
    expected.push_back(backup_name(kBackupTimeUs + hour * kBackupHourUs));
    for (const int later : {kAhead, kAhead + 1})
      expected.push_back(backup_name(kBackupTimeUs + later * kBackupHourUs));
    REQUIRE(names == expected);
  }
  CHECK(verify() == "");
  REQUIRE(ask(BackupFolderRequest::Action::list) == "");
  CHECK_THAT(printed, Contains("is dated in the future"));
}

TEST_CASE_METHOD(FolderBench, "the newest backup has the last edit, whatever the clock said",
                 "[backup]") {
  REQUIRE(add(kAhead) == "");
  const TimeUs now_us = kBackupTimeUs + 3 * kBackupHourUs;
  const auto newest = [&] { return *BackupFolder::open(backups)->newest(now_us); };
  const std::string ahead = backup_name(kBackupTimeUs + kAhead * kBackupHourUs);
  CHECK(newest() == ahead);
  // Nobody has built between the two backups, so they are equal. The one that is not dated in the
  // future is then the newest.
  REQUIRE(add(0) == "");
  CHECK(newest() == backup_name(kBackupTimeUs));
  play(10);
  REQUIRE(add(1) == "");
  CHECK(newest() == backup_name(kBackupTimeUs + kBackupHourUs));
  REQUIRE(restore_backup("", back) == "");
  CHECK(*opened(back)->last_sequence() == kBackupEdits + 10);
  // A later start counts more than any number of edits.
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(add(2) == "");
  CHECK(entries()[2].manifest.epoch == 2);
  CHECK(newest() == backup_name(kBackupTimeUs + 2 * kBackupHourUs));
  // A manifest that cannot be read may be the newest one, unless it is dated in the future.
  std::filesystem::resize_file(backups + "/" + ahead + ".backup", 20);
  CHECK(newest() == backup_name(kBackupTimeUs + 2 * kBackupHourUs));
  std::filesystem::resize_file(
      backups + "/" + backup_name(kBackupTimeUs + 2 * kBackupHourUs) + ".backup", 20);
  CHECK_THAT(restore_backup("", folder / "none"), Contains("choose an older backup"));
}

}  // namespace runstone::test
