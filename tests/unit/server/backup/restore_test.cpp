// A restore: the world that it makes, and when it is refused.
#include <catch2/catch.hpp>
#include <fstream>

#include "common/core/epoch_branch.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/backup/backup_bench.hpp"

using namespace runstone;
using namespace runstone::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE_METHOD(BackupBench, "a restored world has the edits of the backup on a new branch",
                 "[backup]") {
  write_file(world + "/server.toml", "sessions_max = 3\n");
  REQUIRE(back_up_to(copy) == "");
  play(50);  // after the backup
  const Epoch copied = opened(copy)->epoch();
  REQUIRE(restore_to(copy, back) == "");
  CHECK_THAT(printed, Contains("restored    " + copy + " to " + back));
  CHECK_THAT(printed, Contains("other edits than before"));
  const auto restored = opened(back, StoreAccess::read_write);
  CHECK(restored->check().has_value());
  CHECK(*restored->last_sequence() == kBackupEdits);
  CHECK(restored->meta().server_key_seed == store->meta().server_key_seed);
  CHECK(restored->epoch() > copied);
  CHECK_FALSE(is_same_branch(restored->epoch(), copied));
  CHECK_FALSE(is_same_branch(restored->epoch(), store->epoch()));
  CHECK(fs::exists(back + "/server.toml"));
  CHECK(fs::status(back).permissions() == fs::perms::owner_all);

  // The log goes on behind the backup.
  const Epoch epoch = *restored->raise_epoch();
  CHECK(is_same_branch(epoch, epoch - 1));
  CHECK(restored->append({}, sample_records(rng, epoch, kBackupEdits + 1, 3)).has_value());
}

TEST_CASE_METHOD(BackupBench, "two worlds of one backup are on two branches", "[backup]") {
  constexpr TimeUs kTenMinutes = 600'000'000;
  REQUIRE(back_up_to(copy) == "");
  REQUIRE(restore_to(copy, back, kBackupTimeUs + kTenMinutes) == "");
  REQUIRE(restore_to(copy, folder / "again", kBackupTimeUs + 2 * kTenMinutes) == "");
  CHECK_FALSE(is_same_branch(opened(back)->epoch(), opened(folder / "again")->epoch()));
}

TEST_CASE_METHOD(BackupBench, "a restore leaves the backup as it is, also on read-only storage",
                 "[backup]") {
  REQUIRE(back_up_to(copy) == "");
  fs::permissions(copy, fs::perms::owner_read | fs::perms::owner_exec);
  const std::string error = restore_to(copy, back);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(copy)) files += entry.exists() ? 1 : 0;
  fs::permissions(copy, fs::perms::owner_all);
  CHECK(error == "");
  CHECK(files == 2);
}

TEST_CASE_METHOD(BackupBench, "a restore overwrites nothing", "[backup]") {
  REQUIRE(back_up_to(copy) == "");
  CHECK_THAT(restore_to(copy, world), Contains("is not empty"));
  CHECK_THAT(restore_to(copy, copy), Contains("lies in"));
  CHECK_THAT(restore_to(copy, copy + "/inner"), Contains("lies in"));
  CHECK_THAT(restore_to(folder / "none", back), Contains("holds no world"));
  CHECK_FALSE(fs::exists(back));
  CHECK(*opened(world)->last_sequence() == kBackupEdits);
}

TEST_CASE_METHOD(BackupBench, "a damaged backup is not restored", "[backup]") {
  REQUIRE(back_up_to(copy) == "");
  const std::string file = copy + "/world.sqlite";
  SECTION("a row") {
    REQUIRE(raw_sql(file, "UPDATE player SET name = 'x' WHERE author = 1") == "");
    CHECK_THAT(restore_to(copy, back), Contains("player author=1"));
  }
  SECTION("a page") {
    constexpr std::size_t kPageBytes = 2048;
    const std::size_t page = fs::file_size(file) / kPageBytes / 2;
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(page * kPageBytes));
    bytes << std::string(kPageBytes, '\xff');
    bytes.close();
    CHECK(restore_to(copy, back) != "");
  }
  SECTION("a part is missing") {
    fs::resize_file(file, fs::file_size(file) / 2);
    CHECK(restore_to(copy, back) != "");
  }
  CHECK_FALSE(fs::exists(back));
  CHECK_FALSE(fs::exists(back + ".partial"));
}
