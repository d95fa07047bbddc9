// Repairs of worlds with one kind of damage each.
#include <catch2/catch.hpp>

#include "common/core/epoch_branch.hpp"
#include "common/tiles/tile_rules.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/repair/repair_bench.hpp"

namespace runstone::test {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE_METHOD(RepairBench, "a repair of a sound world loses nothing", "[repair][sqlite]") {
  REQUIRE(repair_to(to) == "");
  INFO(printed);
  CHECK_THAT(printed, !Contains("damage ") && !Contains("lost ") && !Contains("ground "));
  const auto store = opened(to);
  CHECK(records_of(*store) == records);
  CHECK(has_same_ground(*store));
  CHECK_FALSE(is_same_branch(store->epoch(), 1));
  CHECK(store->players()->size() == 3);
  CHECK_FALSE(store->high_waters()->empty());
  // The damaged world stays as it is.
  CHECK(opened(world)->check().has_value());
}

TEST_CASE_METHOD(RepairBench, "a lost record becomes a gap", "[repair][sqlite]") {
  // The indexes keep the entry of a row whose other columns are damaged.
  REQUIRE(raw_sql(world_file(),
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 101; SELECT changes()") ==
          "1");
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE seq = 250; SELECT changes()") == "1");
  REQUIRE(repair_to(to) == "");
  INFO(printed);
  const AuthorId author = records.at(101).op.author;
  CHECK_THAT(printed, Contains("damage      edit_log seq=101: checksum is wrong"));
  CHECK_THAT(printed, Contains("lost        seq=101 author=#" + std::to_string(author)));
  CHECK_THAT(printed, Contains(" chunks "));
  CHECK_THAT(printed, Contains("lost        seq=250 between"));
  const auto store = opened(to);
  auto repaired = records_of(*store);
  for (const Sequence seq : {101, 250}) {
    REQUIRE(gap_of(repaired.at(seq).edit) != nullptr);
    CHECK(gap_of(repaired.at(seq).edit)->author == (seq == 101 ? author : 0));
    repaired.at(seq) = records.at(seq);
  }
  std::erase_if(repaired, [](const auto& row) { return row.first > kRepairEdits; });
  CHECK(repaired == records);
  CHECK(raw_sql(to + "/world.sqlite", "PRAGMA user_version") == "11");
}

TEST_CASE_METHOD(RepairBench, "a snapshot shows the ground of records that are all lost",
                 "[repair][sqlite]") {
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE seq BETWEEN 100 AND 199") == "");
  REQUIRE(repair_to(to) == "");
  INFO(printed);
  CHECK_THAT(printed, Contains("ground      chunk="));
  const auto store = opened(to);
  CHECK(has_same_ground(*store));
}

TEST_CASE_METHOD(RepairBench, "lost records come from a backup", "[repair][sqlite]") {
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE seq BETWEEN 20 AND 90") == "");
  REQUIRE(raw_sql(world_file(), "DELETE FROM player WHERE author = 2") == "");
  REQUIRE(repair_to(to, backup) == "");
  INFO(printed);
  CHECK_THAT(printed, Contains("71 records of the log from the backup"));
  CHECK_THAT(printed, !Contains("lost "));
  const auto store = opened(to);
  CHECK(records_of(*store) == records);
  CHECK(has_same_ground(*store));
  CHECK(store->players()->size() == 3);
}

TEST_CASE_METHOD(RepairBench, "a backup of another history gives no records", "[repair][sqlite]") {
  {
    auto other = open_world(backup, StoreAccess::read_write);
    REQUIRE(other.has_value());
    REQUIRE((*other)->begin_branch(kRepairTimeUs).has_value());
    SplitMix64 rng(99);
    REQUIRE((*other)
                ->append({}, sample_records(rng, (*other)->epoch(), kRepairBackup + 1, 20))
                .has_value());
  }
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE seq BETWEEN 140 AND 170") == "");
  REQUIRE(repair_to(to, backup) == "");
  INFO(printed);
  CHECK_THAT(printed, Contains("11 records of the log from the backup"));
  CHECK_THAT(printed, Contains("lost        seq=151"));
}

TEST_CASE("base chunks come from a backup", "[repair][sqlite]") {
  RepairBench bench(3, 100);
  const auto last = std::stoi(raw_sql(bench.world_file(), "SELECT count(*) FROM base"));
  REQUIRE(last > 2);
  REQUIRE(raw_sql(bench.world_file(), "DELETE FROM base WHERE rowid % 2 = 0") == "");
  REQUIRE(bench.repair_to(bench.to, bench.backup) == "");
  INFO(bench.printed);
  CHECK_THAT(bench.printed, Contains("rows of base from the backup"));
  CHECK(bench.has_same_ground(*RepairBench::opened(bench.to)));
}

TEST_CASE_METHOD(RepairBench, "lost watermarks come back from the log", "[repair][sqlite]") {
  const auto marks = opened(world)->high_waters();
  REQUIRE(raw_sql(world_file(), "DELETE FROM player_instance") == "");
  REQUIRE(repair_to(to) == "");
  INFO(printed);
  CHECK_THAT(printed, !Contains("lost "));
  const auto repaired = opened(to)->high_waters();
  REQUIRE((marks.has_value() && repaired.has_value()));
  REQUIRE(repaired->size() == marks->size());
  for (std::size_t i = 0; i < marks->size(); ++i) {
    CHECK((*repaired)[i].author == (*marks)[i].author);
    CHECK((*repaired)[i].instance == (*marks)[i].instance);
    CHECK((*repaired)[i].resolved == (*marks)[i].resolved);
  }
}

TEST_CASE_METHOD(RepairBench, "a world remembers that watermarks are lost with their records",
                 "[repair][sqlite]") {
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE author = 2") == "");
  SECTION("rows are missing") {
    REQUIRE(raw_sql(world_file(), "DELETE FROM player_instance WHERE author = 2") == "");
    REQUIRE(repair_to(to) == "");
    CHECK_THAT(printed, Contains(" that meta counts. Edits of clients that run since before"));
  }
  SECTION("the count of the rows is lost") {
    REQUIRE(raw_sql(world_file(), "DELETE FROM meta WHERE key = 'player_instance_fold'") == "");
    REQUIRE(repair_to(to) == "");
    CHECK_THAT(printed, Contains("meta key=player_instance_fold is lost. Edits of clients"));
  }
  const auto marks = opened(to)->high_waters();
  REQUIRE(marks.has_value());
  const auto lost = std::ranges::find_if(*marks, is_of_lost_watermarks);
  REQUIRE(lost != marks->end());
  CHECK(lost->resolved == 3);
  CHECK(lost->last_us == kRepairTimeUs);
}

TEST_CASE_METHOD(RepairBench, "a world whose watermarks are all there refuses no client",
                 "[repair][sqlite]") {
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE author = 2") == "");
  REQUIRE(repair_to(to) == "");
  const auto marks = opened(to)->high_waters();
  REQUIRE(marks.has_value());
  CHECK(std::ranges::none_of(*marks, is_of_lost_watermarks));
}

TEST_CASE_METHOD(RepairBench, "a lost material table is the built-in one if all rows fit it",
                 "[repair][sqlite]") {
  REQUIRE(raw_sql(world_file(), "DELETE FROM meta WHERE key = 'materials'") == "");
  SECTION("they fit") {
    REQUIRE(repair_to(to) == "");
    INFO(printed);
    CHECK_THAT(printed, Contains("taken       meta key=materials: the built-in table"));
    CHECK_THAT(printed,
               Contains("with " + std::to_string(sample_meta().materials.size()) + " rows"));
    CHECK_THAT(printed, !Contains("lost "));
    const auto store = opened(to);
    CHECK(store->meta().materials == sample_meta().materials);
    CHECK(store->materials()->size() == sample_meta().materials.size() + 1);
    CHECK(records_of(*store) == records);
    CHECK(has_same_ground(*store));
  }
  SECTION("an edit has a material that nothing in the log adds") {
    REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE seq = 60") == "");
    const std::string size = std::to_string(sample_meta().materials.size());
    CHECK_THAT(repair_to(to), Contains("meta key=materials: is lost") &&
                                  Contains("edit_log seq=70 has material " + size +
                                           ", and the table has " + size) &&
                                  Contains("Give the folder of an older backup with --from"));
    CHECK_FALSE(fs::exists(to));
    CHECK(repair_to(to, backup) == "");
  }
}

TEST_CASE("a lost material table of an imported world is not guessed", "[repair][sqlite]") {
  TempFolder folder;
  {
    SplitMix64 rng(5);
    const auto store = *create_world(folder / "world", sample_meta());
    const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {
        {{0, {0, 0, 0}}, sample_chunk(rng, {})}};
    REQUIRE(store->save_base(chunks).has_value());
  }
  REQUIRE(raw_sql(folder / "world/world.sqlite", "DELETE FROM meta WHERE key = 'materials'") == "");
  std::ostringstream out;
  const auto done =
      repair({folder / "world", folder / "new", "", false, false}, kRepairTimeUs, out);
  REQUIRE_FALSE(done.has_value());
  CHECK_THAT(done.error(), Contains("the world was imported, and its table came with it"));
}

TEST_CASE_METHOD(RepairBench, "a repaired world has no tiles, and takes new ones",
                 "[repair][sqlite]") {
  SplitMix64 rng(8);
  const std::vector<std::pair<ChunkKey, ChunkPtr>> tiles = {
      {{1, {0, 0, 0}}, sample_chunk(rng, {1, kRepairBackup})}};
  {
    auto store = open_world(world, StoreAccess::read_write);
    REQUIRE(store.has_value());
    REQUIRE((*store)->save_tiles(tiles, kTileRules).has_value());
    REQUIRE((*store)->tile_keys(kTileRules)->size() == 1);
  }
  REQUIRE(repair_to(to) == "");
  CHECK(raw_sql(to + "/world.sqlite", "SELECT count(*) FROM tile") == "0");
  auto store = open_world(to, StoreAccess::read_write);
  REQUIRE(store.has_value());
  REQUIRE((*store)->save_tiles(tiles, kTileRules).has_value());
  CHECK((*store)->tile_keys(kTileRules)->size() == 1);
}

TEST_CASE_METHOD(RepairBench, "a page of zeros costs the rows in it alone", "[repair][sqlite]") {
  const auto page_bytes = std::stoul(raw_sql(world_file(), "PRAGMA page_size"));
  const auto root = std::stoul(
      raw_sql(world_file(), "SELECT rootpage FROM sqlite_schema WHERE name = 'edit_log'"));
  // The root is an interior page: SQLite finds no row of the log without it.
  overwrite(world_file(), (root - 1) * page_bytes, std::string(page_bytes, '\0'));
  REQUIRE(repair_to(to) == "");
  INFO(printed);
  CHECK_THAT(printed, Contains("damage      page " + std::to_string(root) + ": has only zeros"));
  const auto store = opened(to);
  const auto repaired = records_of(*store);
  std::size_t kept = 0;
  for (const auto& [seq, record] : records) kept += repaired.at(seq) == record ? 1 : 0;
  CHECK(kept > kRepairEdits * 9 / 10);
}

TEST_CASE_METHOD(RepairBench, "the first page is not needed, except for a value of `meta`",
                 "[repair][sqlite]") {
  const auto page_bytes = std::stoul(raw_sql(world_file(), "PRAGMA page_size"));
  overwrite(world_file(), 0, std::string(page_bytes, '\0'));
  REQUIRE(repair_to(to, backup) == "");
  INFO(printed);
  CHECK_THAT(printed, Contains("damage      the header of the database is damaged"));
  CHECK(records_of(*opened(to)) == records);
}

TEST_CASE_METHOD(RepairBench, "lost materials get rows of their own", "[repair][sqlite]") {
  // A later edit has a voxel of the material.
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE seq = 60") == "");
  REQUIRE(repair_to(to) == "");
  INFO(printed);
  CHECK_THAT(printed, Contains("materials   1 rows named lost_ID"));
  const auto materials = opened(to)->materials();
  REQUIRE(materials.has_value());
  CHECK(materials->size() == sample_meta().materials.size() + 1);
}

TEST_CASE("records behind the damage of a write-ahead log are found", "[repair][sqlite]") {
  RepairBench bench(5, 0, true);
  const std::string log = bench.world + "/world.sqlite-wal";
  REQUIRE(fs::file_size(log) > 100'000);
  RepairBench::flip_bit(log, 8 * 60'000);
  REQUIRE(bench.repair_to(bench.to) == "");
  INFO(bench.printed);
  CHECK_THAT(bench.printed, Contains("damage      world.sqlite-wal is damaged"));
  const auto store = RepairBench::opened(bench.to);
  CHECK(RepairBench::records_of(*store).at(kRepairEdits) == bench.records.at(kRepairEdits));
}

TEST_CASE_METHOD(RepairBench, "a repair in place exchanges the folders", "[repair][sqlite]") {
  std::ofstream(world + "/chat.sqlite") << "chat";
  std::ofstream(world + "/server.toml") << "sessions_max = 3\n";
  REQUIRE(raw_sql(world_file(), "DELETE FROM edit_log WHERE seq = 101") == "");
  REQUIRE(repair_to(to, "", true) == "");
  INFO(printed);
  CHECK(opened(world)->check().has_value());
  CHECK(fs::exists(world + "/chat.sqlite"));
  CHECK(fs::exists(world + "/server.toml"));
  CHECK_FALSE(opened(to)->check().has_value());
}

TEST_CASE_METHOD(RepairBench, "a repair is refused with words", "[repair][sqlite]") {
  SECTION("the folder holds no world") {
    fs::remove(world_file());
    CHECK(repair_to(to) == world + ": holds no world");
  }
  SECTION("the new folder is there") { CHECK_THAT(repair_to(backup), Contains(backup)); }
  SECTION("the new folder lies in the world") {
    CHECK(repair_to(world + "/new") == world + "/new: lies in " + world);
  }
  SECTION("a program writes the world") {
    const auto store = open_world(world, StoreAccess::read_write);
    REQUIRE(store.has_value());
    CHECK(repair_to(to) ==
          world + ": another program is writing or repairing this world: stop it first");
  }
  SECTION("the world is of a later version") {
    REQUIRE(raw_sql(world_file(), "PRAGMA user_version = 99") == "");
    CHECK_THAT(repair_to(to), Contains("is of world format 99"));
  }
  SECTION("the backup is damaged, too") {
    REQUIRE(raw_sql(backup + "/world.sqlite", "DELETE FROM edit_log WHERE seq = 9") == "");
    CHECK_THAT(repair_to(to, backup), Contains("the backup is damaged, too"));
  }
  SECTION("the backup is of another world") {
    auto other = sample_meta();
    other.world_id[0] ^= 1;
    REQUIRE(create_world(folder / "other", other).has_value());
    CHECK_THAT(repair_to(to, folder / "other"), Contains("is a backup of another world"));
  }
  SECTION("a value is lost that nothing else has") {
    REQUIRE(raw_sql(world_file(), "DELETE FROM meta WHERE key = 'seed'") == "");
    CHECK_THAT(repair_to(to), Contains("meta key=seed: is lost"));
    CHECK(repair_to(to, backup) == "");
    return;
  }
  CHECK_FALSE(fs::exists(to));
}

}  // namespace runstone::test
