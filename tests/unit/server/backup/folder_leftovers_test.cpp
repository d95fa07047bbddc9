// What a backup in a backup folder leaves after a failure or a kill, and which files are never removed.
#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/unit/server/backup/folder_bench.hpp"

namespace runstone::test {
namespace {

using Catch::Matchers::Contains;

}  // namespace

TEST_CASE_METHOD(FolderBench, "a backup for which the disk gets too full removes its blocks",
                 "[backup]") {
  REQUIRE(add(0) == "");
  play(8'000);
  const auto before = blocks();
  BackupPace pace;
  pace.rest = [&](std::chrono::nanoseconds) {
    if (blocks().size() > before.size()) pace.spare_bytes = 1ULL << 60;  // another program fills it
  };
  const std::string error = add(1, {0, 0, 0}, pace);
  CHECK_THAT(error, Contains("MiB must stay free, but the disk has"));
  CHECK_THAT(error, Contains("`runstone-server backup prune` removes older backups"));
  CHECK(blocks().size() == before.size());
  CHECK(entries().size() == 1);
  CHECK_FALSE(std::filesystem::exists(backups + "/copy.partial"));
  CHECK(verify() == "");
  REQUIRE(add(2) == "");
  CHECK(verify() == "");
}

TEST_CASE_METHOD(FolderBench, "a first backup that was killed leaves a folder that can be used",
                 "[backup]") {
  write_file(backups + "/runstone-backups.new", "runstone ba");
  write_file(backups + "/runstone-backups.new1", "");
  write_file(backups + "/backups.lock", "");
  REQUIRE(add(0) == "");
  const std::string unfinished = backups + "/" + entries()[0].name + ".backup.new3";
  write_file(unfinished, "half");
  write_file(backups + "/diary.backup.new", "mine");
  BackupFolderRequest prune;
  prune.action = BackupFolderRequest::Action::prune;
  prune.policy.daily = 1;
  REQUIRE(run(prune) == "");
  CHECK_FALSE(std::filesystem::exists(unfinished));
  CHECK_FALSE(std::filesystem::exists(backups + "/runstone-backups.new"));
  CHECK_FALSE(std::filesystem::exists(backups + "/runstone-backups.new1"));
  CHECK(std::filesystem::exists(backups + "/diary.backup.new"));
  CHECK(entries().size() == 1);
}

TEST_CASE_METHOD(FolderBench, "blocks are removed only where a backup writes them", "[backup]") {
  REQUIRE(add(0) == "");
  play(100);
  REQUIRE(add(1) == "");
  BackupFolderRequest prune;
  prune.action = BackupFolderRequest::Action::prune;
  prune.policy.hourly = 1;
  const TimeUs now_us = kBackupTimeUs + 2 * kBackupHourUs;
  const std::string name(64, 'a');
  SECTION("files of such names in other folders stay") {
    std::filesystem::create_directories(backups + "/blocks/aa/inner");
    std::filesystem::create_directories(backups + "/blocks/ab");
    const std::string here = backups + "/blocks/aa/" + name;
    const std::string inner = backups + "/blocks/aa/inner/" + name;
    const std::string other = backups + "/blocks/ab/" + name;
    const std::string above = backups + "/blocks/" + name;
    for (const std::string& file : {here, inner, other, above}) write_file(file, "x");
    REQUIRE(run(prune, now_us) == "");
    CHECK_FALSE(std::filesystem::exists(here));  // a block that no manifest names
    for (const std::string& file : {inner, other, above}) CHECK(std::filesystem::exists(file));
    CHECK(verify() == "");
  }
  SECTION("a link to another folder is not followed") {
    std::filesystem::rename(backups + "/blocks", folder / "elsewhere");
    std::filesystem::create_directory_symlink(folder / "elsewhere", backups + "/blocks");
    const std::size_t before = blocks().size();
    CHECK_THAT(run(prune, now_us), Contains("/blocks: is a symbolic link, so no block is removed"));
    CHECK(blocks().size() == before);
    CHECK(verify() == "");
  }
}

TEST_CASE_METHOD(FolderBench, "a lock that cannot be taken is no permission to go on", "[backup]") {
  REQUIRE(add(0) == "");
  std::filesystem::remove(backups + "/backups.lock");
  std::filesystem::create_directory(backups + "/backups.lock");
  CHECK_THAT(verify(), Contains("/backups.lock: Is a directory"));
  CHECK_THAT(restore_backup("", back), Contains("/backups.lock: Is a directory"));
  BackupFolderRequest prune;
  prune.action = BackupFolderRequest::Action::prune;
  prune.policy.hourly = 1;
  CHECK_THAT(run(prune), Contains("/backups.lock: Is a directory"));
  CHECK(ask(BackupFolderRequest::Action::list) == "");
}

}  // namespace runstone::test
