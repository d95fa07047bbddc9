// A backup in a backup folder, of a world on a disk with faults: it is whole or not there, and those of
// before stay.
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>
#include <string>

#include "server/backup/backup_folder.hpp"
#include "server/backup/folder_program.hpp"
#include "tests/support/sql/disk_fault.hpp"
#include "tests/unit/server/backup/backup_bench.hpp"

namespace runstone::test {

TEST_CASE_METHOD(BackupBench,
                 "an error of the disk leaves the older backups of a folder as they are",
                 "[backup][faults]") {
  const std::string backups = folder / "backups";
  std::filesystem::create_directory(backups);
  BackupFolderRequest request;
  request.folder = backups;
  request.world = world;
  TimeUs now_us = kBackupTimeUs;
  const auto carry_out = [&](BackupFolderRequest::Action action) {
    std::ostringstream out;
    request.action = action;
    now_us += 1'000'000;
    const auto done = run_backup_folder(request, now_us, out, {});
    return done ? std::string() : done.error();
  };
  const auto count = [&] { return BackupFolder::open(backups)->names()->size(); };
  REQUIRE(carry_out(BackupFolderRequest::Action::add) == "");
  store.reset();  // so that the world has no files that are open
  std::size_t made = 1;
  // All calls of a backup take minutes, because each run waits for the real disk.
  const std::uint64_t runs = meet_disk_faults(397, [&](FaultVfs& vfs, const DiskFault& fault) {
    const std::string error = carry_out(BackupFolderRequest::Action::add);
    vfs.heal();
    INFO(error);
    if (error.empty()) {
      ++made;
    } else {
      CHECK(says_why(error, fault));
    }
    CHECK(count() == made);
    CHECK(carry_out(BackupFolderRequest::Action::verify) == "");
    CHECK_FALSE(std::filesystem::exists(backups + "/copy.partial"));
  });
  CHECK(runs > 3);
}

}  // namespace runstone::test
