// A backup on a disk with faults: it is whole or not there, harms nothing, and an error says why.
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <string>

#include "tests/support/sql/disk_fault.hpp"
#include "tests/unit/server/backup/backup_bench.hpp"

namespace runstone::test {

TEST_CASE_METHOD(BackupBench, "an error of the disk leaves a whole backup or none, and says why",
                 "[backup][faults]") {
  store.reset();  // so that the world has no files that are open
  // All calls of a backup take minutes, because each run waits for the real disk.
  constexpr std::uint64_t kStride = 61;
  const std::uint64_t runs = meet_disk_faults(kStride, [&](FaultVfs& vfs, const DiskFault& fault) {
    const std::string error = back_up_to(copy);
    vfs.heal();
    INFO(error);
    if (error.empty()) {
      const auto read = opened(copy);
      CHECK(*read->last_sequence() == kBackupEdits);
      CHECK(read->check().has_value());
    } else {
      CHECK(says_why(error, fault));
      // An error of the disk is no damage.
      CHECK(error.find("not sound") == std::string::npos);
      std::set<std::string> names;
      for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        names.insert(entry.path().filename().string());
      CHECK(names == std::set<std::string>{"world"});
    }
    std::filesystem::remove_all(copy);
  });
  CHECK(runs > 20);
  const auto source = opened(world);
  CHECK(*source->last_sequence() == kBackupEdits);
  CHECK(source->check().has_value());
}

}  // namespace runstone::test
