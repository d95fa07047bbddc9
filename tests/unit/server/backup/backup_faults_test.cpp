// A backup on a disk with faults: it is whole or not there, harms nothing, and an error says why. The
// hidden case [.long] meets every call of a backup: unit_server_backup "[.long]".
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <string>

#include "tests/support/sql/disk_fault.hpp"
#include "tests/unit/server/backup/backup_bench.hpp"

namespace runstone::test {
namespace {

struct FaultyBackupBench : BackupBench {
  /// Backs the world up with each fault at every `stride`-th call of the system (meet_disk_faults()).
  void back_up_on_faulty_disks(std::uint64_t stride) {
    store.reset();  // so that the world has no files that are open
    const std::uint64_t runs = meet_disk_faults(stride, [&](FaultVfs& vfs, const DiskFault& fault) {
      const std::string error = back_up_to(copy);
      vfs.heal();
      check_backup(error, fault);
      std::filesystem::remove_all(copy);
    });
    CHECK(runs > 20);
    const auto source = opened(world);
    CHECK(*source->last_sequence() == kBackupEdits);
    CHECK(source->check().has_value());
  }

 private:
  /// `error` is that of the backup, or empty.
  void check_backup(const std::string& error, const DiskFault& fault) {
    INFO(error);
    if (error.empty()) {
      const auto read = opened(copy);
      CHECK(*read->last_sequence() == kBackupEdits);
      CHECK(read->check().has_value());
      return;
    }
    CHECK(says_why(error, fault));
    // An error of the disk is no damage.
    CHECK(error.find("not sound") == std::string::npos);
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      names.insert(entry.path().filename().string());
    CHECK(names == std::set<std::string>{"world"});
  }
};

}  // namespace

TEST_CASE_METHOD(FaultyBackupBench,
                 "an error of the disk leaves a whole backup or none, and says why",
                 "[backup][faults]") {
  // All calls of a backup take minutes, because each run waits for the real disk.
  back_up_on_faulty_disks(61);
}

TEST_CASE_METHOD(FaultyBackupBench,
                 "an error of the disk at any call leaves a whole backup or none, and says why",
                 "[.long]") {
  back_up_on_faulty_disks(1);
}

}  // namespace runstone::test
