// A backup: what it holds, and what it leaves behind when it fails.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "common/core/epoch_branch.hpp"
#include "tests/support/sql/full_disk_vfs.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/backup/backup_bench.hpp"

using namespace runstone;
using namespace runstone::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// Parts so small that the sample world has many.
BackupPace small_parts(std::function<void()> between) {
  BackupPace pace;
  pace.part_pages = 4;
  pace.flush_parts = 3;
  pace.rest = [between = std::move(between)](std::chrono::nanoseconds) { between(); };
  return pace;
}

}  // namespace

TEST_CASE_METHOD(BackupBench, "a backup under constant writing is of one moment, and verified",
                 "[backup]") {
  int parts = 1;
  REQUIRE(back_up_to(copy, small_parts([&] {
                       ++parts;
                       play(20);
                     })) == "");
  REQUIRE(parts > 10);
  CHECK(*store->last_sequence() == kBackupEdits + 20 * static_cast<Sequence>(parts - 1));
  CHECK_THAT(printed, Contains("moment      epoch=1 seq=400\n"));
  CHECK_THAT(printed, Contains("400 edits up to seq=400"));
  const auto read = opened(copy);
  CHECK(*read->last_sequence() == kBackupEdits);
  CHECK(read->check().has_value());
  CHECK(read->players()->size() == 2);
  CHECK(read->meta().server_key_seed == store->meta().server_key_seed);
  CHECK(read->meta().world_id == store->meta().world_id);
}

TEST_CASE_METHOD(BackupBench, "a backup has what a restore needs, for its owner alone",
                 "[backup]") {
  write_file(world + "/server.toml", "sessions_max = 3\n");
  write_file(world + "/port", "4747\n");
  write_file(world + "/control.sock", "");
  fs::create_directory(world + "/previews");
  fs::create_symlink("/etc/hostname", world + "/foreign.toml");
  REQUIRE(back_up_to(copy) == "");
  CHECK(names_in(copy) == std::set<std::string>{"server.toml", "world.durable", "world.sqlite"});
  CHECK_THAT(printed, Contains("left out    foreign.toml port previews\n"));
  CHECK(fs::status(copy).permissions() == fs::perms::owner_all);
  for (const auto& entry : fs::directory_iterator(copy)) {
    CAPTURE(entry.path());
    CHECK(entry.status().permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  }
  CHECK_FALSE(fs::exists(copy + ".partial"));
}

TEST_CASE_METHOD(BackupBench, "a server that runs on a copied folder is on a branch of its own",
                 "[backup]") {
  REQUIRE(back_up_to(copy) == "");
  const auto served = opened(copy, StoreAccess::read_write);
  const Epoch epoch = *served->raise_epoch();
  CHECK_FALSE(is_same_branch(epoch, store->epoch()));
  CHECK(epoch > store->epoch());
}

TEST_CASE_METHOD(BackupBench, "a backup is refused where it would overwrite or be lost",
                 "[backup]") {
  const auto refused = [&](const std::string& to, const std::string& why) {
    CAPTURE(to, why);
    CHECK_THAT(back_up_to(to), Contains(why));
    CHECK_FALSE(fs::exists(to + ".partial"));
  };
  fs::create_directory(folder / "full");
  write_file(folder / "full/notes", "mine");
  refused(folder / "full", "is not empty");
  refused(folder / "full/", "is not empty");
  refused(folder / "full/notes", "is there and is no folder");
  refused(world + "/backup", "lies in " + world);
  refused(world, "lies in " + world);
  refused(folder / "world/../world/deep", "lies in " + world);
  refused(folder / "missing/backup", "is no folder");
  fs::create_directory_symlink(world, folder / "link");
  refused(folder / "link/backup", "lies in " + world);
  fs::create_directory_symlink(folder / "nowhere", folder / "dangling");
  refused(folder / "dangling", "is a symbolic link");
  CHECK(names_in(folder / "full") == std::set<std::string>{"notes"});
  CHECK_FALSE(fs::exists(folder / "nowhere"));

  std::ostringstream out;
  const auto none = back_up({folder / "full", copy, false}, kBackupTimeUs, out, {});
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error() == folder / "full" + ": holds no world");
  CHECK_FALSE(fs::exists(copy + ".partial"));
}

TEST_CASE_METHOD(BackupBench, "an empty folder takes a backup", "[backup]") {
  fs::create_directory(copy);
  REQUIRE(back_up_to(copy + "/") == "");
  CHECK(opened(copy)->check().has_value());
}

TEST_CASE_METHOD(BackupBench, "a killed backup leaves a partial folder, which the next one removes",
                 "[backup]") {
  const pid_t child = ::fork();
  if (child == 0) {
    int parts = 0;
    static_cast<void>(back_up_to(copy, small_parts([&] {
                                   if (++parts == 5) ::raise(SIGKILL);
                                 })));
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFSIGNALED(status));
  CHECK_FALSE(fs::exists(copy));
  REQUIRE(fs::exists(copy + ".partial/world.sqlite"));
  CHECK_FALSE(open_world(copy + ".partial", StoreAccess::read_write).has_value());

  REQUIRE(back_up_to(copy) == "");
  CHECK_THAT(printed, Contains("removed     " + copy + ".partial, which was interrupted\n"));
  CHECK_FALSE(fs::exists(copy + ".partial"));
  CHECK(opened(copy)->check().has_value());
}

TEST_CASE_METHOD(BackupBench, "a partial folder of somebody else is not removed", "[backup]") {
  const std::string partial = copy + ".partial";
  SECTION("no backup made it") {
    fs::create_directory(partial);
    write_file(partial + "/thesis.txt", "mine");
    CHECK_THAT(back_up_to(copy), Contains("is not what an interrupted program leaves"));
    CHECK(fs::exists(partial + "/thesis.txt"));
  }
  SECTION("it is a link") {
    fs::create_directory(folder / "other");
    write_file(folder / "other/partial.lock", "");
    fs::create_directory_symlink(folder / "other", partial);
    CHECK_THAT(back_up_to(copy), Contains("is not what an interrupted program leaves"));
    CHECK(fs::exists(folder / "other/partial.lock"));
  }
  SECTION("another backup is writing it") {
    std::string second;
    REQUIRE(back_up_to(copy, small_parts([&, done = false]() mutable {
                         if (std::exchange(done, true)) return;
                         std::ostringstream out;
                         const auto refused = back_up({world, copy, false}, kBackupTimeUs, out, {});
                         second = refused ? "" : refused.error();
                       })) == "");
    CHECK_THAT(second, Contains("another program is writing it"));
  }
}

TEST_CASE_METHOD(BackupBench, "a copy that is not sound is removed", "[backup]") {
  SECTION("a damaged row") {
    store.reset();
    REQUIRE(raw_sql(world + "/world.sqlite",
                    "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 200") == "");
    CHECK_THAT(back_up_to(copy), Contains("edit_log seq=200"));
  }
  SECTION("a missing row") {
    store.reset();
    REQUIRE(raw_sql(world + "/world.sqlite", "DELETE FROM edit_log WHERE seq = 200") == "");
    CHECK_THAT(back_up_to(copy), Contains("seq=200"));
  }
  SECTION("a world that has lost edits") {
    store.reset();
    fs::copy_file(world + "/world.sqlite", folder / "old.sqlite");
    store = opened(world, StoreAccess::read_write);
    play(10);
    store.reset();
    fs::rename(folder / "old.sqlite", world + "/world.sqlite");
    CHECK_THAT(back_up_to(copy), Contains("seq=401 to seq=410 are lost"));
  }
  CHECK_FALSE(fs::exists(copy));
  CHECK_FALSE(fs::exists(copy + ".partial"));
}

TEST_CASE_METHOD(BackupBench, "a setting file that finds no room ends a backup with the reason",
                 "[backup]") {
  // The database of a world without edits is smaller than this file.
  const std::string small = folder / "small";
  REQUIRE((*create_world(small, sample_meta()))->raise_epoch().has_value());
  write_file(small + "/server.toml", std::string(1'000'000, '#'));
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit limit{900'000, before.rlim_max};
  const auto signalled = ::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  std::ostringstream out;
  const auto done = back_up({small, copy, false}, kBackupTimeUs, out, {});
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &before) == 0);
  ::signal(SIGXFSZ, signalled);
  REQUIRE_FALSE(done.has_value());
  CHECK_THAT(done.error(), Contains("server.toml: cannot be written: File too large"));
  CHECK_FALSE(fs::exists(copy));
  CHECK_FALSE(fs::exists(copy + ".partial"));
}

TEST_CASE_METHOD(BackupBench, "a full disk ends a backup and leaves nothing that looks finished",
                 "[backup]") {
  SECTION("before the copy begins") {
    BackupPace pace;
    pace.spare_bytes = 1ULL << 60;
    CHECK_THAT(back_up_to(copy, pace), Contains("MiB must stay free, but the disk has"));
  }
  SECTION("in the middle") {
    store.reset();
    FullDiskVfs disk;
    store = opened(world, StoreAccess::read_write);
    CHECK_THAT(back_up_to(copy, small_parts([&] { disk.fill(); })), Contains("full"));
    disk.make_room();
    store.reset();
  }
  CHECK_FALSE(fs::exists(copy));
  CHECK_FALSE(fs::exists(copy + ".partial"));
}
