// Backups in a backup folder: what they share, what is made of them, and what becomes of damage and
// of a program that was killed.
#include "server/backup/backup_folder.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "common/core/hex.hpp"
#include "tests/unit/server/backup/folder_bench.hpp"

namespace runstone::test {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

}  // namespace

TEST_CASE_METHOD(FolderBench, "a world is restored as it was at the newest or a named backup",
                 "[backup]") {
  write_file(world + "/server.toml", "sessions_max = 3\n");
  REQUIRE(add(0) == "");
  CHECK_THAT(printed, Contains("verified    the database, every row, and 400 edits"));
  play(30);
  REQUIRE(add(1) == "");
  const auto all = entries();
  REQUIRE(all.size() == 2);
  CHECK(all[0].name == backup_name(kBackupTimeUs));
  CHECK(all[0].manifest.seq == kBackupEdits);
  CHECK(all[1].manifest.seq == kBackupEdits + 30);
  CHECK_FALSE(fs::exists(backups + "/copy.partial"));

  REQUIRE(restore_backup("", back) == "");
  CHECK_THAT(printed, Contains("backup      " + all[1].name));
  const auto newest = opened(back);
  CHECK(*newest->last_sequence() == kBackupEdits + 30);
  CHECK(newest->check().has_value());
  CHECK(newest->meta().server_key_seed == store->meta().server_key_seed);
  CHECK(fs::exists(back + "/server.toml"));
  CHECK(fs::status(back + "/world.sqlite").permissions() ==
        (fs::perms::owner_read | fs::perms::owner_write));

  REQUIRE(restore_backup(all[0].name, folder / "older") == "");
  CHECK(*opened(folder / "older")->last_sequence() == kBackupEdits);
  CHECK_THAT(restore_backup("20200101T000000Z", folder / "none"), Contains("holds no backup"));
  CHECK_THAT(restore_to(backups, back), Contains("is not empty"));
  CHECK_THAT(restore_backup("", backups + "/inner"), Contains("lies in"));
}

TEST_CASE_METHOD(FolderBench, "a further backup stores what has changed, and no more", "[backup]") {
  play(6'000);
  REQUIRE(add(0) == "");
  const std::uint64_t first = block_bytes();
  CHECK(entries()[0].manifest.new_bytes == first);
  play(1);
  REQUIRE(add(1) == "");
  const std::uint64_t second = block_bytes() - first;
  CHECK(entries()[1].manifest.new_bytes == second);
  CHECK(second > 0);
  // The pages of the record, of its index and of the counters lie in a few blocks.
  CHECK(second <= 8 * kBlockBytes);
  CHECK(first > 20 * kBlockBytes);
}

TEST_CASE_METHOD(FolderBench, "pruning removes what no other backup needs, and the rest is whole",
                 "[backup]") {
  for (int hour = 0; hour < 5; ++hour) {
    REQUIRE(add(hour) == "");
    play(200);
  }
  write_file(backups + "/blocks/notes.txt", "mine");
  BackupFolderRequest prune;
  prune.action = BackupFolderRequest::Action::prune;
  CHECK_THAT(run(prune), Contains("say what stays"));
  prune.policy.hourly = 2;
  prune.is_rehearsal = true;
  const TimeUs now_us = kBackupTimeUs + 5 * kBackupHourUs;
  REQUIRE(run(prune, now_us) == "");
  CHECK_THAT(printed, Contains("would go    " + backup_name(kBackupTimeUs)));
  CHECK(entries().size() == 5);
  prune.is_rehearsal = false;
  const std::uint64_t before = block_bytes();
  REQUIRE(run(prune, now_us) == "");
  CHECK_THAT(printed, Contains("removed     " + backup_name(kBackupTimeUs)));
  REQUIRE(entries().size() == 2);
  CHECK(block_bytes() < before);
  CHECK(fs::exists(backups + "/blocks/notes.txt"));
  CHECK(verify() == "");
  REQUIRE(restore_backup(backup_name(kBackupTimeUs + 3 * kBackupHourUs), back) == "");
  CHECK(opened(back)->check().has_value());
  // The blocks are exactly those that the two manifests name.
  std::set<std::string> needed;
  const auto opened_folder = BackupFolder::open(backups);
  for (const auto& entry : entries()) {
    for (const auto& file : opened_folder->read(entry.name).manifest.files) {
      for (const BlockHash& hash : file.blocks) needed.insert(to_hex(hash));
    }
  }
  std::set<std::string> there;
  for (const auto& file : blocks()) there.insert(file.filename().string());
  there.erase("notes.txt");
  CHECK(there == needed);
}

TEST_CASE_METHOD(FolderBench, "a backup with a policy removes older ones", "[backup]") {
  REQUIRE(add(0, {1, 0, 0}) == "");
  REQUIRE(add(1, {1, 0, 0}) == "");
  CHECK_THAT(printed, Contains("removed     " + backup_name(kBackupTimeUs)));
  REQUIRE(entries().size() == 1);
  CHECK(entries()[0].taken_us == kBackupTimeUs + kBackupHourUs);
}

TEST_CASE_METHOD(FolderBench, "a damaged block is found, named, and made anew by the next backup",
                 "[backup]") {
  REQUIRE(add(0) == "");
  REQUIRE(verify() == "");
  const fs::path block = blocks()[blocks().size() / 2];
  SECTION("a byte is changed") {
    std::fstream bytes(block, std::ios::in | std::ios::out | std::ios::binary);
    const char first = static_cast<char>(bytes.get());
    bytes.seekp(0);
    bytes.put(static_cast<char>(first ^ 1));
  }
  SECTION("it is cut off") { fs::resize_file(block, 5); }
  SECTION("it is gone") { fs::remove(block); }
  CHECK_THAT(verify(), Contains("1 of 1 backups are damaged"));
  CHECK_THAT(printed, Contains(block.filename().string()));
  CHECK(restore_backup("", back) != "");
  CHECK_FALSE(fs::exists(back));
  CHECK_FALSE(fs::exists(back + ".partial"));
  // The world has not changed, but the copy is another branch: only its first pages may differ.
  REQUIRE(add(1) == "");
  CHECK(restore_backup("", back) == "");
}

TEST_CASE_METHOD(FolderBench, "a damaged manifest harms no other backup, and no block is removed",
                 "[backup]") {
  REQUIRE(add(0) == "");
  play(100);
  REQUIRE(add(1) == "");
  const std::string older = backups + "/" + backup_name(kBackupTimeUs) + ".backup";
  fs::resize_file(older, fs::file_size(older) / 2);
  CHECK_THAT(verify(), Contains("1 of 2 backups are damaged"));
  const std::uint64_t before = block_bytes();
  play(100);
  REQUIRE(add(2, {1, 0, 0}) == "");
  CHECK_THAT(printed, Contains("warning     " + older + ": "));
  CHECK(block_bytes() >= before);
  CHECK(entries().size() == 2);  // the damaged one does not count, and stays
  REQUIRE(restore_backup("", back) == "");
  CHECK_THAT(restore_backup(backup_name(kBackupTimeUs), folder / "none"),
             Contains("choose an older backup"));
}

TEST_CASE_METHOD(FolderBench, "a backup folder is of one world, and holds nothing else",
                 "[backup]") {
  SECTION("foreign files") {
    write_file(backups + "/thesis.txt", "mine");
    CHECK_THAT(add(0), Contains("holds files that are no backups"));
    CHECK_FALSE(BackupFolder::is_one(backups));
  }
  SECTION("another world") {
    REQUIRE(add(0) == "");
    const auto all = entries();
    WorldMeta meta = sample_meta();
    meta.world_id[0] = 0x77;
    REQUIRE((*create_world(folder / "other", meta))->raise_epoch().has_value());
    BackupFolderRequest request;
    request.action = BackupFolderRequest::Action::add;
    request.world = folder / "other";
    CHECK_THAT(run(request), Contains("holds backups of another world"));
    CHECK(entries().size() == all.size());
  }
  SECTION("the folder is gone") {
    fs::remove(backups);
    CHECK_THAT(add(0), Contains("is no folder: make it, or mount its disk"));
    CHECK_FALSE(fs::exists(backups));
    CHECK_THAT(verify(), Contains("is no folder"));
  }
  SECTION("another program uses it") {
    REQUIRE(add(0) == "");
    const auto taken = BackupFolder::open_for(backups, store->meta().world_id);
    REQUIRE(taken.has_value());
    CHECK_THAT(add(1), Contains("another program is using it"));
    CHECK_THAT(verify(), Contains("another program is using it"));
    CHECK(ask(BackupFolderRequest::Action::list) == "");
  }
  SECTION("a mark of a newer version") {
    write_file(backups + "/runstone-backups", "runstone backups 2\n");
    CHECK_THAT(add(0), Contains("newer version"));
  }
  SECTION("two backups of one second") {
    REQUIRE(add(0) == "");
    CHECK_THAT(add(0), Contains("is there"));
    CHECK(entries().size() == 1);
  }
}

TEST_CASE_METHOD(FolderBench, "the folders of a world and of its backups do not lie in each other",
                 "[backup]") {
  BackupFolderRequest request;
  request.action = BackupFolderRequest::Action::add;
  request.world = world;
  std::ostringstream out;
  for (const std::string& inner : {world, world + "/backups", folder.path()}) {
    CAPTURE(inner);
    request.folder = inner;
    const auto done = run_backup_folder(request, kBackupTimeUs, out, {});
    REQUIRE_FALSE(done.has_value());
    CHECK_THAT(done.error(), Contains("lies in"));
  }
}

TEST_CASE_METHOD(FolderBench, "a backup that was killed leaves nothing that counts", "[backup]") {
  REQUIRE(add(0) == "");
  play(8'000);
  const std::size_t before = blocks().size();
  const bool is_early = GENERATE(true, false);  // while it copies, and while it stores blocks
  const pid_t child = ::fork();
  if (child == 0) {
    BackupPace pace;
    pace.part_pages = 64;
    int parts = 0;
    pace.rest = [&](std::chrono::nanoseconds) {
      if (is_early ? ++parts == 2 : blocks().size() > before) ::raise(SIGKILL);
    };
    static_cast<void>(add(1, {0, 0, 0}, pace));
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFSIGNALED(status));
  CHECK(entries().size() == 1);
  CHECK(verify() == "");
  CHECK(fs::exists(backups + "/copy.partial"));
  write_file(blocks().front().string() + ".new", "half of a block");
  REQUIRE(add(2) == "");
  CHECK_FALSE(fs::exists(backups + "/copy.partial"));
  for (const auto& file : blocks()) CHECK(file.extension() != ".new");
  CHECK(entries().size() == 2);
  CHECK(verify() == "");
}

TEST_CASE_METHOD(FolderBench, "a full disk ends a backup with words, and older ones stay",
                 "[backup]") {
  REQUIRE(add(0) == "");
  play(50);
  BackupPace pace;
  pace.spare_bytes = 1ULL << 60;
  CHECK_THAT(add(1, {1, 0, 0}, pace), Contains("MiB must stay free, but the disk has"));
  CHECK(entries().size() == 1);
  CHECK_FALSE(fs::exists(backups + "/copy.partial"));
  fs::rename(backups + "/blocks", backups + "/away");
  write_file(backups + "/blocks", "in the way");
  CHECK_THAT(add(1), Contains("cannot be made"));
  CHECK(entries().size() == 1);
  fs::remove(backups + "/blocks");
  fs::rename(backups + "/away", backups + "/blocks");
  CHECK(verify() == "");
}

TEST_CASE_METHOD(FolderBench, "the list of backups is text or JSON", "[backup]") {
  REQUIRE(add(0) == "");
  BackupFolderRequest list;
  REQUIRE(run(list) == "");
  CHECK_THAT(printed, Contains(backup_name(kBackupTimeUs) + "  epoch=1 seq=400 bytes="));
  list.json = true;
  REQUIRE(run(list) == "");
  const auto read = nlohmann::json::parse(printed);
  CHECK(read["world"] == to_hex(store->meta().world_id));
  REQUIRE(read["backups"].size() == 1);
  CHECK(read["backups"][0]["name"] == backup_name(kBackupTimeUs));
  CHECK(read["backups"][0]["taken"] == "2026-11-18T11:06:40Z");
  CHECK(read["backups"][0]["seq"] == kBackupEdits);
  CHECK(read["backups"][0]["bytes"] == entries()[0].manifest.bytes());
}

}  // namespace runstone::test
