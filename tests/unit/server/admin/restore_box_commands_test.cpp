// The command that makes a box of the running world as it was in a backup.
#include "server/admin/restore_box_commands.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "common/core/utc_text.hpp"
#include "server/admin/command_table.hpp"
#include "server/store/copy_stored_world.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

/// The builder builds a house. Then a backup is made, and the griefer digs it away.
struct RestoreBench : CommandBench {
  RestoreBench()
      : services{bench.server,
                 service,
                 *this,
                 placing,
                 folder.path(),
                 {},
                 [](const PublicKey&) {
              return false; }} {
    join(kGriefer);
    join(kBuilder);
    fill(kBuilder, {{0, 0, 0}, {4, 4, 4}}, 2);
    write_log();
    first = bench.environment.records.back().time_us;
    bench.time_us += 60'000'000;
    fill(kBuilder, {{0, 0, 0}, {4, 1, 4}}, 3);
    write_log();
    REQUIRE(copy_stored_world(folder.path(), backup).has_value());
    fill(kGriefer, {{0, 0, 0}, {8, 8, 8}}, kEmpty);
    set(kBuilder, {7, 7, 7}, 2);
    write_log();
  }
  CommandAnswer give(const CommandCaller& caller, const std::string& line) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    for (int i = 0; i < 400; ++i) {
      placing.tick(bench.now());
      run_all();
      services.tick(bench.now());
      if (!answers.empty() && answers.back().is_done) return answers.back();
    }
    FAIL("no answer");
    return {};
  }
  CommandAnswer restore(const std::string& words) {
    return give({}, "restore-box " + backup + " " + words);
  }

  TempFolder backups;
  std::string backup = backups / "backup";
  TimeUs first = 0;  // when the house was built
  CommandServices services;
};

}  // namespace

TEST_CASE("a box becomes as it was in a backup, and nothing beside it", "[admin][backup]") {
  RestoreBench bench;
  const std::string box = "box 0 0 0 3 3 3";
  const CommandAnswer preview = bench.restore(box);
  CHECK_FALSE(preview.is_ok);
  CHECK(contains(preview.text, "64 voxels would change"));
  CHECK(contains(preview.text, box + " anyway"));
  CHECK(bench.at({0, 0, 0}) == kEmpty);

  const CommandAnswer done = bench.restore(box + " anyway");
  INFO(done.text);
  REQUIRE(done.is_ok);
  CHECK(bench.at({0, 0, 0}) == 3);
  CHECK(bench.at({0, 1, 0}) == 2);
  CHECK(bench.at({7, 7, 7}) == 2);
  CHECK(contains(bench.restore(box).text, "nothing to restore"));
}

TEST_CASE("a box becomes as it was at a moment of a backup", "[admin][backup]") {
  RestoreBench bench;
  const std::string moment = " at " + utc_text(bench.first + 1'000'000);
  const CommandAnswer done = bench.restore("box 0 0 0 7 7 7" + moment + " anyway");
  INFO(done.text);
  REQUIRE(done.is_ok);
  CHECK(bench.at({0, 0, 0}) == 2);
  CHECK(bench.at({7, 7, 7}) == kEmpty);  // a voxel that was built since is removed, too
}

TEST_CASE("bad backups, boxes and callers are refused with words", "[admin][backup]") {
  RestoreBench bench;
  CHECK(contains(bench.give({}, "restore-box /nowhere box 0 0 0 1 1 1").text, "/nowhere"));
  CHECK(contains(bench.restore("0 0 0 1 1 1").text, "box X Y Z X Y Z comes after the folder"));
  CHECK(contains(bench.restore("box 0 0 0 999 999 999").text, "restore it in parts"));
  CHECK(contains(bench.restore("box 0 0 0 1 1 1 at 1970-01-01").text, "before its first edit"));
  WorldMeta meta = sample_meta();
  meta.world_id[0] ^= 1;
  REQUIRE(create_world(bench.backups / "other", meta).has_value());
  CHECK(
      contains(bench.give({}, "restore-box " + (bench.backups / "other") + " box 0 0 0 1 1 1").text,
               "is a backup of another world"));
  meta = sample_meta();
  meta.chunk_edge = meta.chunk_edge == 16 ? 32 : 16;
  REQUIRE(create_world(bench.backups / "edges", meta).has_value());
  CHECK(
      contains(bench.give({}, "restore-box " + (bench.backups / "edges") + " box 0 0 0 1 1 1").text,
               "has the id of this world, but other chunks"));
  std::filesystem::create_directory(bench.backups / "fifo");
  REQUIRE(::mkfifo((bench.backups / "fifo/world.sqlite").c_str(), 0600) == 0);
  CHECK(
      contains(bench.give({}, "restore-box " + (bench.backups / "fifo") + " box 0 0 0 1 1 1").text,
               "is no regular file"));
  const PublicKey key = key_pair_of(seed_of(kBuilder)).public_key;
  CHECK_FALSE(
      bench.give({kBuilder, {key, true}}, "restore-box " + bench.backup + " box 0 0 0 1 1 1")
          .is_ok);
}

}  // namespace runstone::test
